// The geometry of scene.glb that instances share: attributes, indices and the compact form of the lightmap's charts.
#pragma once

#include <vector>

#include "io/glb_builder.h"
#include "io/lit_mesh_plan.h"

namespace lumel {

// One primitive per part: everything but TEXCOORD_1, material and page.
Result<std::vector<Json>> write_geometry(const GltfDocument& document, const SharedGeometry& geometry, GlbBuilder& glb);

}  // namespace lumel
