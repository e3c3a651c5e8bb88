// The lightmapped instances of scene.glb: each a mesh object of its own over shared geometry, with its lightmap UVs,
// its materials and the transforms of its charts.
#pragma once

#include <cstdint>
#include <vector>

#include "io/glb_builder.h"
#include "io/lit_materials.h"
#include "io/lit_mesh_plan.h"

namespace lumel {

// Accessors with one entry per chart of each instance, in the order of Atlas::placements; kNone: nothing is lit.
struct ChartBuffer {
    std::uint32_t transforms = kNone;  // VEC4: chart_transforms()
    std::uint32_t pages = kNone;       // unsigned integers
};

// `primitives`: of each of the plan's geometries (lit_geometry.h).
ChartBuffer write_lit_instances(const GltfWriteInput& input, const LitMeshPlan& plan,
                                const std::vector<std::vector<Json>>& primitives, LitMaterials& materials,
                                GlbBuilder& glb);

}  // namespace lumel
