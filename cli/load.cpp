#include "load.h"

#include "base/try.h"
#include "encode/irradiance.h"
#include "io/image_io.h"

namespace lumel::cli {

Result<LoadedScene> load_lit_scene(const std::string& path, const BakeOptions& options, Context& context) {
    LUMEL_TRY(LoadedScene loaded, load_scene(path, context));
    if (!options.sky.file.empty()) {
        loaded.scene.sky = {};
        LUMEL_TRY(loaded.scene.sky.map, read_sky(options.sky.file));
    }
    LUMEL_TRY_STATUS(apply_lighting(loaded.scene, options));
    return loaded;
}

PathOptions picture_path(const BakeOptions& options) {
    PathOptions path;
    path.bounces = options.bounces;
    path.seed = options.seed;
    path.layer_scale = layer_weights(options.include);
    path.layer_scale[static_cast<std::size_t>(Layer::direct)] *= static_cast<float>(options.direct_scale);
    path.layer_scale[static_cast<std::size_t>(Layer::sky)] *= static_cast<float>(options.direct_scale);
    path.layer_scale[static_cast<std::size_t>(Layer::indirect)] *= static_cast<float>(options.indirect_scale);
    return path;
}

}  // namespace lumel::cli
