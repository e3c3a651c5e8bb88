// What stays of the file's accessors and buffer views in scene.glb.
#pragma once

#include "io/glb_builder.h"
#include "io/lit_mesh_plan.h"

namespace lumel {

// Data that only replaced meshes used is dropped; the rest is written again under its number, plain where it was
// compressed. The builder holds the document as it was read.
Status keep_used_data(const GltfDocument& document, const LitMeshPlan& plan, GlbBuilder& glb);

}  // namespace lumel
