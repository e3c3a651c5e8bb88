// Scene plus the lighting that the options ask for.
#pragma once

#include "command.h"
#include "io/gltf_document.h"

namespace lumel::cli {

// Reads the scene and the sky map named by options.sky.file, then applies sky and sun.
Result<LoadedScene> load_lit_scene(const std::string& path, const BakeOptions& options, Context& context);

}  // namespace lumel::cli
