// glTF materials, textures and samplers to Material and Texture. Everything is a Lambertian surface here: metals keep
// their base colour as diffuse, coats, sheen and transmission are left out (and said to be).
#pragma once

#include <vector>

#include "io/gltf_document_internal.h"
#include "lumel/context.h"
#include "lumel/scene.h"

namespace lumel {

// Fills scene.materials (glTF's, then the default material as the last) and scene.textures with those images that the
// materials marked in `used` need: base colour, and emission where it is not black.
// Diagnostics: "ignored-extension", "diffuse-transmission", "clamped-factor".
Status read_materials(const GltfDocument& document, const std::vector<bool>& used, Scene& scene,
                      Diagnostics& diagnostics);

}  // namespace lumel
