#include "load.h"

#include "base/try.h"
#include "io/image_io.h"
#include "io/light_record.h"

namespace lumel::cli {

Result<LoadedScene> load_lit_scene(const std::string& path, const BakeOptions& options, Context& context) {
    LUMEL_TRY(LoadedScene loaded, load_scene(path, context));
    if (!options.sky.file.empty()) {
        loaded.scene.sky = {};
        LUMEL_TRY(loaded.scene.sky.map, read_sky(options.sky.file));
        LUMEL_TRY(loaded.sky_hash, hash_file(options.sky.file));
    }
    LUMEL_TRY_STATUS(apply_lighting(loaded.scene, options));
    return loaded;
}

BakedLight light_of(BakedLighting& baked) {
    return {[&baked](std::uint32_t triangle, float b1, float b2) { return baked.irradiance(triangle, b1, b2); },
            baked.parts(), [&baked](std::uint32_t part) { return baked.load(part); }};
}

}  // namespace lumel::cli
