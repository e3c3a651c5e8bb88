// The main job by the package alone: reads a scene of white floor from a file, bakes it under a sky of radiance 1,
// whose irradiance over pi is 1 everywhere, and looks at the pixels and the files.
//   consumer SCENE FOLDER
#include <lumel/lumel.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace {

// Paths see nothing but sky, but are drawn with density (1/2 + cos)/(2 pi): a path's weight 2 cos/(1/2 + cos) has a
// variance of ln 3 - 1. Of 64 paths, which are spread more evenly than this counts on, five deviations; and of the mean
// over thousands of texels no more than what their spreading leaves.
constexpr float kTexelTolerance = 0.2f;
constexpr double kMeanTolerance = 1e-3;

int fail(const char* what) {
    std::fprintf(stderr, "consumer: %s\n", what);
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return fail("usage: consumer SCENE FOLDER");
    const std::filesystem::path folder = argv[2];

    lumel::BakeOptions options;
    options.texels_per_metre = 8;
    options.samples = 64;
    options.sky.color = lumel::Vec3{1, 1, 1};
    lumel::Context context;
    const lumel::Result<lumel::LoadedScene> loaded = lumel::load_lit_scene(argv[1], options, context);
    if (!loaded) return fail(loaded.error().text().c_str());

    int pages = 0, baked = 0, wrong = 0;
    double sum = 0.0;
    lumel::FolderOptions to;
    to.views = 1;
    to.view_samples = 1;
    to.page = [&](const lumel::PagePixels& page) {
        ++pages;
        for (std::uint32_t y = 0; y < page.height; ++y)
            for (std::uint32_t x = 0; x < page.width; ++x) {
                const std::size_t i = page.index(x, y);
                if (page.coverage[i] != lumel::Coverage::baked) continue;
                ++baked;
                for (std::size_t c = 0; c < 3; ++c) wrong += std::abs(page.irradiance[i][c] - 1.0f) > kTexelTolerance;
                sum += page.irradiance[i].y;
            }
        return lumel::success();
    };
    const lumel::Result<lumel::BakeReport> report = lumel::bake_to_folder(*loaded, options, folder, to, context);
    if (!report) return fail(report.error().text().c_str());

    std::printf("consumer: %d page, %d texels, mean E/pi %.4f\n", pages, baked, report->mean_irradiance[1]);
    if (pages != 1 || baked == 0 || static_cast<std::uint64_t>(baked) != report->texels)
        return fail("texels are missing");
    if (wrong > 0) return fail("a texel is not 1");
    if (std::abs(sum / baked - 1.0) > kMeanTolerance) return fail("the mean of the texels is not 1");
    if (std::abs(sum / baked - report->mean_irradiance[1]) > 1e-6) return fail("the report has another mean");
    for (const char* name : {"scene.glb", "lightmap_0.exr", "master_0.exr", "manifest.json", "report.json",
                             "preview_atlas_0.png", "preview_view_0.png"})
        if (!std::filesystem::exists(folder / name) || std::filesystem::file_size(folder / name) == 0)
            return fail(name);

    // What was written is a scene again, and its layout one that a later bake can keep.
    const lumel::Result<lumel::LoadedScene> lit = lumel::load_scene(folder / "scene.glb", context);
    if (!lit) return fail(lit.error().text().c_str());
    if (context.diagnostics.count("already-baked") != 1) return fail("scene.glb is not known for a bake's");
    const auto layout = lumel::read_atlas_record(folder / "manifest.json");
    if (!layout) return fail(layout.error().text().c_str());

    // Nothing appears where the caller says so.
    to.may_appear = [] { return false; };
    const std::filesystem::path other = folder.string() + "-not";
    const auto refused = lumel::bake_to_folder(*loaded, options, other, to, context);
    if (refused || refused.error().code != lumel::ErrorCode::cancelled || std::filesystem::exists(other))
        return fail("a folder appeared that should not");
    return 0;
}
