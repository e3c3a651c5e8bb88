// Texels per CPU second: rasterising the pages of a scene, then expanding the sample points of every texel. With
// --pictures the pages are written as PNG, to be looked at.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "bench.h"
#include "chart/chart_set.h"
#include "io/image_io.h"
#include "load.h"
#include "texel/texel_buffer.h"
#include "texel/texel_picture.h"

namespace lumel::bench {
namespace {

struct Options {
    std::string scene, pictures;
    std::uint32_t resolution = 0, threads = 1;
    double texels = 1e6;
};

std::uint64_t bytes_of(const TexelBuffer& t) {
    const std::uint64_t per_texel = 2 + 2 + 8 + 4 + 12 + 12 + 4;
    return t.size() * per_texel + 4 * (t.triangles.size() + t.texel_at.size());
}

void write_pictures(const TexelBuffer& texels, const std::filesystem::path& folder) {
    const auto write = [&](const char* name, const Image& image) {
        std::vector<std::uint8_t> bytes(image.data.size());
        for (std::size_t i = 0; i < bytes.size(); ++i)
            bytes[i] = static_cast<std::uint8_t>(std::clamp(image.data[i], 0.0f, 1.0f) * 255.0f + 0.5f);
        const std::string file = std::string(name) + "_" + std::to_string(texels.page) + ".png";
        need(write_png(folder / file, image.width, image.height, 3, bytes));
    };
    write("position", position_picture(texels));
    write("normal", normal_picture(texels));
    write("world_size", world_size_picture(texels));
    write("triangle", triangle_picture(texels));
    write("validity", validity_picture(texels));
}

void run_texels(const Options& options) {
    Context context(options.threads);
    const LoadedScene loaded = need(load_scene(options.scene, context));
    const Scene& scene = loaded.scene;
    const WorldGeometry geometry = need(flatten(scene, context));
    ChartOptions chart_options;
    chart_options.resolution_width = chart_options.resolution_height = options.resolution;
    chart_options.texel_budget = options.texels;
    const ChartSet charts = need(make_charts(scene, geometry, chart_options, context));
    const Atlas atlas = need(make_atlas(scene, geometry, charts, chart_options, context));
    const auto by_page = triangles_by_page(scene, geometry, charts, atlas);

    std::printf(
        "scene,page,width,height,triangles,texels,threads,rasterize_mtexels_per_cpu_second,"
        "samples_mtexels_per_cpu_second,points_per_texel,bytes_per_texel,overlaps\n");
    for (std::uint32_t page = 0; page < by_page.size(); ++page) {
        const CpuStopwatch rasterize;
        const TexelBuffer texels = need(rasterize_page(scene, geometry, charts, atlas, page, by_page[page], context));
        const double rasterize_seconds = rasterize.seconds();
        const CpuStopwatch expand;
        std::uint64_t points = 0;
        std::array<SamplePoint, kSamplesPerTexel> out;
        for (std::size_t i = 0; i < texels.size(); ++i)
            points += sample_points(texels, i, scene, geometry, charts, atlas, out);
        const double n = static_cast<double>(texels.size());
        std::printf("%s,%u,%u,%u,%zu,%zu,%u,%.3f,%.3f,%.1f,%.1f,%llu\n", base_name(options.scene).c_str(), page,
                    texels.width, texels.height, by_page[page].size(), texels.size(), options.threads,
                    1e-6 * n / rasterize_seconds, 1e-6 * n / expand.seconds(), static_cast<double>(points) / n,
                    static_cast<double>(bytes_of(texels)) / n,
                    static_cast<unsigned long long>(context.diagnostics.count("chart-overlap")));
        if (!options.pictures.empty()) write_pictures(texels, options.pictures);
    }
}

}  // namespace

void add_texels(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("texels", "Rasterising pages and expanding sample points");
    command->add_option("scene", options->scene, ".glb or .gltf")->required()->check(CLI::ExistingFile);
    command->add_option("--resolution", options->resolution, "One square page of this size; 0: as the budget needs");
    command->add_option("--texels", options->texels, "Texel budget where no resolution is given");
    command->add_option("--threads", options->threads)->check(CLI::Range(1u, 1024u));
    command->add_option("--pictures", options->pictures, "Folder for PNG pictures of the pages")
        ->check(CLI::ExistingDirectory);
    command->callback([options] { run_texels(*options); });
}

}  // namespace lumel::bench
