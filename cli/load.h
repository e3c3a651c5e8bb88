// Scene plus the lighting that the options ask for, or that a bake has.
#pragma once

#include "command.h"
#include "io/baked.h"
#include "io/gltf_document.h"
#include "render/picture.h"

namespace lumel::cli {

// Reads the scene and the sky map named by options.sky.file, then applies sky and sun.
Result<LoadedScene> load_lit_scene(const std::string& path, const BakeOptions& options, Context& context);

// For render_picture; borrows `baked`.
BakedLight light_of(BakedLighting& baked);

}  // namespace lumel::cli
