// Any bytes as the scene.glb of an output folder: `render --baked` says no, or has light for every triangle.
#include <unistd.h>

#include <fstream>

#include "base/check.h"
#include "fuzz/mutate_glb.h"
#include "fuzz/seed_corpus.h"
#include "io/baked.h"
#include "io/gltf_write.h"
#include "io/image_io.h"
#include "io/page_files.h"
#include "support/load_gltf.h"

namespace {

namespace fs = std::filesystem;
using namespace lumel;

test::GltfBuilder two_triangles() {
    test::GltfBuilder builder;
    const std::size_t triangle = builder.triangle();
    builder.node({{"mesh", triangle}});
    builder.node({{"mesh", triangle}, {"translation", {2, 0, 0}}});
    return builder;
}

// What was baked, and the folder that its bake left.
struct Bake {
    Bake() {
        fs::create_directories(folder);
        ChartOptions options;
        options.texels_per_metre = 8;
        geometry = flatten(loaded.scene(), loaded.context).value();
        const ChartSet charts = make_charts(loaded.scene(), geometry, options, loaded.context).value();
        const Atlas atlas = make_atlas(loaded.scene(), geometry, charts, options, loaded.context).value();
        std::vector<LitTexture> textures;
        for (std::uint32_t p = 0; p < atlas.pages.size(); ++p) {
            const AtlasPage& page = atlas.pages[p];
            const std::vector<std::uint8_t> pixels(std::size_t{page.width} * page.height * 3);
            textures.push_back({encode_png(page.width, page.height, 3, pixels), 1.0f});
            const Image image(page.width, page.height, 3);
            (void)write_exr(folder / page_file(PageFile::lightmap, p), image, ExrType::half);
        }
        (void)write_lit_gltf(folder / kSceneFile, {*loaded.result->document, loaded.scene(), charts, atlas, textures,
                                                   Include{}, hash_geometry(geometry)});
    }
    ~Bake() {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }

    const fs::path folder = fs::temp_directory_path() / ("lumel-fuzz-baked-" + std::to_string(::getpid()));
    test::Loaded loaded{two_triangles()};
    WorldGeometry geometry;
};

const Bake& bake() {
    static const Bake the_one;
    return the_one;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    fuzz::seed_corpus(*argc, *argv, {read_file(bake().folder / kSceneFile, 1 << 20).value()});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    return fuzz::mutate_glb(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::ofstream(bake().folder / kSceneFile, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    const Scene& scene = bake().loaded.scene();
    const Result<BakedLighting> baked = read_baked(bake().folder, scene, bake().geometry);
    if (!baked.ok()) return 0;
    for (std::uint32_t triangle = 0; triangle < bake().geometry.triangle_count(); ++triangle) {
        const std::optional<Vec3> light = baked->irradiance(triangle, 0.25f, 0.5f);
        if (light) LUMEL_CHECK(light->x == 0.0f, light->x);
    }
    return 0;
}
