// load_lit_scene: a scene's file, and the lighting that the options ask for.
#include "base/try.h"
#include "io/image_io.h"
#include "io/light_record.h"
#include "light/dark_sky.h"
#include "lumel/bake.h"
#include "lumel/load.h"

namespace lumel {

Result<LoadedScene> load_lit_scene(const std::filesystem::path& path, const BakeOptions& options, Context& context) {
    LUMEL_TRY(LoadedScene loaded, load_scene(path, context));
    if (!options.sky.file.empty()) {
        loaded.scene.sky = {};
        LUMEL_TRY(loaded.scene.sky.map, read_sky(options.sky.file));
        LUMEL_TRY(loaded.sky_hash, hash_file(options.sky.file));
    }
    LUMEL_TRY_STATUS(apply_lighting(loaded.scene, options));
    warn_of_dark_sky(loaded.scene, context.diagnostics);
    return loaded;
}

}  // namespace lumel
