// Scene plus the lighting that the options ask for.
#pragma once

#include "command.h"
#include "io/gltf_document.h"
#include "path/path_integrator.h"

namespace lumel::cli {

// Reads the scene and the sky map named by options.sky.file, then applies sky and sun.
Result<LoadedScene> load_lit_scene(const std::string& path, const BakeOptions& options, Context& context);

// How a picture is path-traced that shows what a bake with these options holds: the same layers, scaled alike.
PathOptions picture_path(const BakeOptions& options);

}  // namespace lumel::cli
