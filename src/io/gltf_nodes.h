// The node graph of the scene to bake: who is there, where in the world, and what hangs on it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_document_internal.h"
#include "lumel/scene.h"

namespace lumel {

// An affine map in double: chains of node transforms keep their precision until the one rounding at the end.
struct AffineD {
    std::array<std::array<double, 3>, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};  // axes, translation
    [[nodiscard]] Affine rounded() const;
};
AffineD operator*(const AffineD& a, const AffineD& b);

// Translation, rotation (quaternion x, y, z, w; any length but zero) and scale.
AffineD compose(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
                const std::array<double, 3>& scale);

struct SceneNode {
    std::uint32_t index = kNone;   // in nodes
    std::uint32_t parent = kNone;  // in nodes; kNone for roots
    std::string name;              // "node 12" where the file has none
    bool named = false;
    std::uint64_t path_hash = 0;  // of the names from the root down, "" where there is none; instances share it
    AffineD world;
    std::optional<std::uint64_t> mesh, camera, light;
    bool skinned = false, animated = false;  // animated: it or an ancestor is the target of an animation
    std::optional<bool> lightmap;            // extras.lightmap of the nearest of it and its ancestors that has it
    std::vector<AffineD> instances;          // of EXT_mesh_gpu_instancing, relative to the node; empty without it
};

// Nodes of the default scene (else the first, else all), in the order of the file. Errors: cycles, nodes with two
// parents, indices out of range, transforms that are not finite or not affine.
Result<std::vector<SceneNode>> read_nodes(const GltfDocument& document);

// Instance transforms of EXT_mesh_gpu_instancing, relative to the node; at most `limit`. In gltf_instancing.cpp.
Result<std::vector<AffineD>> read_instancing(const GltfDocument& document, const Json& extension, std::uint64_t limit,
                                             const std::string& where);

}  // namespace lumel
