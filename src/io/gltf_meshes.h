// glTF meshes to Mesh: primitives joined, strips and fans unrolled, normals made, every vertex's origin remembered.
#pragma once

#include <memory>

#include "io/gltf_document_internal.h"
#include "lumel/context.h"
#include "lumel/scene.h"

namespace lumel {

// How many vertices and triangles a file may expand to: many primitives may share one accessor, so that a small file
// could ask for any amount.
class ExpansionBudget {
public:
    explicit ExpansionBudget(std::uint64_t file_bytes) : left_((std::uint64_t{1} << 20) + 16 * file_bytes) {}
    Status take(std::uint64_t items, const std::string& where);

private:
    std::uint64_t left_;
};

struct ReadMesh {
    std::shared_ptr<const Mesh> mesh;  // null where no primitive has triangles
    MeshSource source;
};

// Reads meshes[index]. Diagnostics: "skipped-primitive", "missing-normals", "zero-length-normal", "morph-targets".
Result<ReadMesh> read_mesh(const GltfDocument& document, std::uint64_t index, ExpansionBudget& budget,
                           Diagnostics& diagnostics);

}  // namespace lumel
