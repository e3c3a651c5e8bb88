// The punctual lights of scene.glb: those that are in the bake go.
#pragma once

#include "io/gltf_document_internal.h"

namespace lumel {

// Lights whose direct light the bake holds would light the scene twice: they are taken off the nodes of `root` and kept
// in the nodes' extras. `scene` is what `document` was loaded as.
void remove_baked_lights(const GltfDocument& document, const Scene& scene, Json& root);

}  // namespace lumel
