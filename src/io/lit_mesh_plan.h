// What goes where in scene.glb: which meshes are cut into which parts, who shares them, and what of the file's own data
// they can keep.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "io/gltf_document_internal.h"
#include "io/gltf_write.h"
#include "io/mesh_split.h"

namespace lumel {

// A part and what of the file's own accessors it can keep using.
struct PartPlan {
    MeshPart part;
    bool keeps_vertices = false;  // the part's vertices are the accessors' elements, all and in order
    bool keeps_indices = false;
    std::uint32_t old_uv1 = 1;  // the set that the file's TEXCOORD_1 moves to; 1: it does not
};

// What all instances of a mesh share whose charts are spread over pages in the same way.
struct SharedGeometry {
    std::uint32_t mesh = kNone;  // Scene::meshes
    std::vector<PartPlan> parts;
};

struct InstancePlan {
    std::uint32_t display = kNone;     // Scene::display
    std::size_t geometry = 0;          // LitMeshPlan::geometries
    std::vector<std::uint32_t> pages;  // by the parts' group
};

struct LitMeshPlan {
    std::vector<SharedGeometry> geometries;
    std::vector<InstancePlan> instances;
    std::set<std::uint32_t> replaced_meshes;  // of the file: every node gets meshes of its own
    std::set<std::uint32_t> expanded_nodes;   // whose EXT_mesh_gpu_instancing becomes child nodes
};

Result<LitMeshPlan> plan_lit_meshes(const GltfWriteInput& input);

// The file's JSON of a mesh and of a primitive, by their numbers in the scene.
const Json& gltf_mesh(const GltfDocument& document, std::uint32_t scene_mesh);
const Json& gltf_primitive(const GltfDocument& document, std::uint32_t scene_mesh, std::uint32_t primitive);
// Points, lines and whatever else the bake does not know of a mesh, in the file's numbers: they stay as they are.
std::vector<std::uint32_t> skipped_primitives(const GltfDocument& document, std::uint32_t scene_mesh);

}  // namespace lumel
