// Any bytes as the scene.glb of an output folder: `lumel check` says no, or has figures that are numbers.
#include <cmath>

#include "base/check.h"
#include "check/verdict.h"
#include "fuzz/baked_folder.h"
#include "fuzz/mutate_glb.h"
#include "io/read_bake.h"

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
    const fuzz::BakedFolder& folder = fuzz::baked_folder();
    folder.put_scene(data, size);
    Context context(1);
    const Result<BakeOnDisk> disk = read_bake(folder.folder, context);
    if (!disk.ok()) return 0;
    const CheckedBake& bake = disk->bake;
    for (const CheckedTriangle& t : bake.triangles)
        LUMEL_CHECK(t.page < bake.pages.size() && t.instance < bake.instances.size(), t.page, t.instance);
    const auto geometry = flatten(disk->scene, context);
    if (!geometry.ok()) return 0;
    const auto tracer = make_embree_tracer(*geometry, SurfaceReader(disk->scene, *geometry), context);
    if (!tracer.ok()) return 0;
    const SeamCheck seams = check_seams(bake, {}, **tracer, context).value();
    const TexelCheck texels = check_texels(bake, {}, context).value();
    for (const Finding& f : judge(seams, texels, {})) LUMEL_CHECK(std::isfinite(f.value), f.name);
    return 0;
}
