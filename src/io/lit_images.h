// The images of scene.glb: those of the file, and the pages of the no-code form.
#pragma once

#include <span>
#include <vector>

#include "io/glb_builder.h"
#include "io/gltf_write.h"
#include "io/lit_materials.h"

namespace lumel {

// Images move into the file: it is read in another folder than the one it came from.
Status embed_images(const GltfDocument& document, GlbBuilder& glb);

// One texture per page.
std::vector<PageTexture> add_page_textures(std::span<const LitTexture> pages, GlbBuilder& glb);

}  // namespace lumel
