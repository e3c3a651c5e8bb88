// Any bytes as the scene.glb of an output folder: `render --baked` says no, or has light for every triangle.
#include "base/check.h"
#include "fuzz/baked_folder.h"
#include "fuzz/mutate_glb.h"

using namespace lumel;

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    fuzz::seed_baked_scene(*argc, *argv);
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    return fuzz::mutate_glb(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const fuzz::BakedFolder& bake = fuzz::baked_folder();
    bake.put_scene(data, size);
    const Result<BakedLighting> baked = read_baked(bake.folder, bake.loaded.scene(), bake.geometry);
    if (!baked.ok()) return 0;
    for (std::uint32_t triangle = 0; triangle < bake.geometry.triangle_count(); ++triangle) {
        const std::optional<Vec3> light = baked->irradiance(triangle, 0.25f, 0.5f);
        if (light) LUMEL_CHECK(light->x == 0.0f, light->x);
    }
    return 0;
}
