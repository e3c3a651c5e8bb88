#include "load.h"

#include "base/try.h"
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

}  // namespace lumel::cli
