// Who uses which accessor of a glTF document, as far as the specification and the extensions we know say.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "io/json_read.h"
#include "lumel/scene.h"

namespace lumel {

class AccessorUse {
public:
    explicit AccessorUse(std::size_t accessors) : kinds_(accessors) {}

    void note_vertices(std::uint32_t accessor) { note(accessor, kVertices); }
    void note_indices(std::uint32_t accessor) { note(accessor, kIndices); }
    void note_other(std::uint32_t accessor) { note(accessor, kOther); }

    [[nodiscard]] bool used(std::size_t accessor) const { return kinds_[accessor] != 0; }
    [[nodiscard]] bool is_vertices(std::size_t accessor) const { return (kinds_[accessor] & kVertices) != 0; }
    [[nodiscard]] bool is_indices(std::size_t accessor) const { return (kinds_[accessor] & kIndices) != 0; }

private:
    static constexpr std::uint8_t kVertices = 1, kIndices = 2, kOther = 4;
    void note(std::uint32_t accessor, std::uint8_t kind) {
        if (accessor < kinds_.size()) kinds_[accessor] = static_cast<std::uint8_t>(kinds_[accessor] | kind);
    }
    std::vector<std::uint8_t> kinds_;
};

// Attributes and morph targets of a primitive.
void note_vertex_accessors(const Json& primitive, AccessorUse& use);

// Meshes, skins, animations, EXT_mesh_gpu_instancing.
void note_accessor_use(const Json& root, AccessorUse& use);
// The same as if these meshes, and the instancing of these nodes, were not there.
void note_accessor_use_without(const Json& root, const std::set<std::uint32_t>& meshes,
                               const std::set<std::uint32_t>& instancing_nodes, AccessorUse& use);

}  // namespace lumel
