// Contrast along the seams of real scenes, by the checker's own search: as baked, with the seed's lines drawn over
// them, and solved. And what that changed elsewhere, and cost.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench.h"
#include "bench_scene.h"
#include "check/seam_check.h"
#include "image/tonemap.h"
#include "io/image_io.h"
#include "line_blend.h"
#include "load.h"
#include "lumel/bake.h"
#include "path/path_integrator.h"
#include "seam/blend_seams.h"

namespace lumel::bench {
namespace {

struct Options {
    std::vector<std::string> scenes;
    std::string pictures;
    unsigned threads = 1;
    std::uint32_t samples_per_texel = 64, max_page = 4096;
    double density = 0.0;
    bool preview = false;
    SeamOptions solver;
};

// What a bake leaves, kept so that seams can be blended again and again.
struct Baked {
    ChartSet charts;
    Atlas atlas;
    std::vector<Lightmap> pages;
    CheckedBake checked;
};

Image light_of(const Lightmap& map) {
    Image out(map.width, map.height, 3);
    for (std::size_t i = 0; i < map.texel_at.size(); ++i)
        if (const std::uint32_t t = map.texel_at[i]; t != kNone)
            for (const LayerMoments& layer : map.texels.layers[t])
                for (std::size_t c = 0; c < 3; ++c) out.data[3 * i + c] += layer.irradiance[c];
    return out;
}

CheckedPage checked_page(const Lightmap& map) {
    CheckedPage page{map.width, map.height, light_of(map), std::vector<TexelState>(map.texel_at.size()), {}};
    for (std::size_t i = 0; i < page.state.size(); ++i)
        if (const std::uint32_t t = map.texel_at[i]; t != kNone)
            page.state[i] = static_cast<TexelState>(map.coverage[t]);
    return page;
}

void add_triangles(const Scene& scene, const WorldGeometry& geometry, Baked& baked) {
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
        const auto uv = baked.atlas.triangle_uv(baked.charts, geometry, scene, t);
        if (uv.page == kNone) continue;
        CheckedTriangle out{geometry.corners(t), {}, {}, uv.page, geometry.triangles[t].instance};
        const AtlasPage& page = baked.atlas.pages[uv.page];
        for (std::size_t k = 0; k < 3; ++k) {
            out.normal[k] = geometry.shading_normal(t, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f);
            out.uv[k] = {uv.texels[k].x / static_cast<float>(page.width),
                         uv.texels[k].y / static_cast<float>(page.height)};
        }
        baked.checked.triangles.push_back(out);
    }
    for (const Instance& instance : scene.instances) baked.checked.instances.push_back(instance.name);
}

// Rms change of the baked texels that lie beside no seam, relative to the rms light: those that `touched` says nothing
// of.
double change_elsewhere(const Baked& baked, const std::vector<std::vector<std::uint8_t>>& touched,
                        const std::vector<Image>& now) {
    double change = 0.0, light = 0.0;
    for (std::size_t p = 0; p < now.size(); ++p) {
        const CheckedPage& page = baked.checked.pages[p];
        for (std::size_t i = 0; i < page.state.size(); ++i) {
            if (page.state[i] != TexelState::baked || touched[p][i] != 0) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                const double before = static_cast<double>(page.light.data[3 * i + c]);
                const double difference = static_cast<double>(now[p].data[3 * i + c]) - before;
                change += difference * difference;
                light += before * before;
            }
        }
    }
    return light > 0.0 ? std::sqrt(change / light) : 0.0;
}

struct Row {
    const char* method;
    double cpu_seconds;
};

void print(const std::string& scene, const Row& row, const Baked& baked, std::uint64_t texels,
           const std::vector<std::vector<std::uint8_t>>& touched, std::vector<Image> pages, const Options& options,
           const Tracer& tracer, Context& context) {
    const double elsewhere = change_elsewhere(baked, touched, pages);
    CheckedBake checked = baked.checked;
    for (std::size_t p = 0; p < pages.size(); ++p) checked.pages[p].light = std::move(pages[p]);
    const SeamCheck seams = need(check_seams(checked, {}, tracer, context));
    std::printf("%s,%s,%llu", scene.c_str(), row.method, static_cast<unsigned long long>(texels));
    for (const SeamContrast& c : {seams.open, seams.parted})
        std::printf(",%llu,%.1f,%.2f,%.4f,%.4f,%.2f", static_cast<unsigned long long>(c.samples), c.metres,
                    c.visible_metres, 100.0 * c.median, 100.0 * c.p99, 100.0 * c.largest);
    std::printf(",%.5f,%.3f,%.3f\n", 100.0 * elsewhere, row.cpu_seconds,
                1e6 * row.cpu_seconds / static_cast<double>(texels));
    std::fflush(stdout);
    if (options.pictures.empty()) return;
    std::filesystem::create_directories(options.pictures);
    const float exposure = auto_exposure(baked.checked.pages[0].light);
    for (std::size_t p = 0; p < checked.pages.size(); ++p)
        need(write_png(
            std::filesystem::path(options.pictures) / (scene + "_" + row.method + "_" + std::to_string(p) + ".png"),
            checked.pages[p].width, checked.pages[p].height, 3, tonemap(checked.pages[p].light, exposure)));
}

void mark(const std::vector<SeamSample>& samples, LookupFilter filter, const Baked& baked,
          std::vector<std::vector<std::uint8_t>>& touched) {
    for (const SeamSample& sample : samples)
        for (const SeamPoint& point : {sample.a, sample.b}) {
            const AtlasPage& page = baked.atlas.pages[point.page];
            lookup_at(filter, point.texels)
                .for_each(page.width, page.height, [&](std::uint32_t x, std::uint32_t y, float) {
                    touched[point.page][std::size_t{y} * page.width + x] = 1;
                });
        }
}

void compare_methods(const std::string& name, const Transport& transport, Baked& baked, const Options& options,
                     Context& context) {
    add_triangles(transport.scene, transport.geometry, baked);
    std::uint64_t texels = 0;
    std::vector<Image> as_baked;
    std::vector<std::vector<std::uint8_t>> touched;
    for (const Lightmap& map : baked.pages) {
        baked.checked.pages.push_back(checked_page(map));
        as_baked.push_back(baked.checked.pages.back().light);
        touched.emplace_back(map.texel_at.size());
        texels += map.texels.size();
    }
    const SeamRule rule;
    const CpuStopwatch search_time;
    const auto edges = find_border_edges(transport.scene, transport.geometry, baked.charts, baked.atlas);
    const auto seams = need(find_seams(edges, rule, context));
    const SeamSamples samples =
        need(make_seam_samples(edges, seams, rule, options.solver.samples_per_texel, transport.tracer, context));
    const double search = search_time.seconds();
    mark(samples.samples, options.solver.filter, baked, touched);
    print(name, {"none", 0.0}, baked, texels, touched, as_baked, options, transport.tracer, context);

    std::vector<std::uint32_t> instance;
    for (const WorldTriangle& t : transport.geometry.triangles) instance.push_back(t.instance);
    constexpr std::uint32_t kPasses = 16;
    const CpuStopwatch line_time;
    std::vector<Image> lines = as_baked;
    blend_lines(edges, seams, instance, kPasses, lines);
    print(name, {"lines", line_time.seconds()}, baked, texels, touched, std::move(lines), options, transport.tracer,
          context);

    const CpuStopwatch solve_time;
    SeamBlender blender(samples.samples, baked.atlas, options.solver);
    std::vector<Image> solved;
    for (const Lightmap& map : baked.pages) {
        Lightmap copy = map;
        need(blender.blend(copy, context));
        solved.push_back(light_of(copy));
    }
    print(name, {"squares", search + solve_time.seconds()}, baked, texels, touched, std::move(solved), options,
          transport.tracer, context);
    std::fprintf(stderr, "%s: %zu edges, %zu seams, %.1f m, %zu samples, %llu hidden, search %.3f cpu-s\n",
                 name.c_str(), edges.size(), seams.size(), samples.metres, samples.samples.size(),
                 static_cast<unsigned long long>(samples.hidden), search);
}

void run_scene(const std::string& path, const Options& options) {
    Context context(options.threads);
    const Scene scene = load_lit(path, context);
    BakeOptions bake_options;
    bake_options.preset = options.preview ? Preset::preview : Preset::medium;
    bake_options.samples = options.samples_per_texel;
    bake_options.texels_per_metre = options.density;
    bake_options.max_page = options.max_page;
    bake_options.threads = options.threads;
    bake_options.seams = false;
    Baked baked;
    BakeSink sink;
    sink.layout = [&](const WorldGeometry&, const ChartSet& charts, const Atlas& atlas) {
        baked.charts = charts;
        baked.atlas = atlas;
        return success();
    };
    sink.page = [&](const Lightmap& map) {
        baked.pages.push_back(map);
        return success();
    };
    const std::string name = std::filesystem::path(path).stem().string();
    sink.finished = [&](const Transport& transport, BakeReport&) {
        compare_methods(name, transport, baked, options, context);
        return success();
    };
    need(bake(scene, bake_options, sink, context));
}

void run(const Options& options) {
    std::printf(
        "scene,method,texels,samples,metres,visible_metres,median_percent,p99_percent,largest_percent,"
        "parted_samples,parted_metres,parted_visible_metres,parted_median_percent,parted_p99_percent,"
        "parted_largest_percent,elsewhere_rms_percent,cpu_seconds,cpu_seconds_per_million_texels\n");
    for (const std::string& scene : options.scenes) run_scene(scene, options);
}

}  // namespace

void add_seams(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("seams", "Contrast along seams: as baked, lines drawn over, least squares");
    command->add_option("scenes", options->scenes, ".glb or .gltf")->required()->check(CLI::ExistingFile);
    command->add_option("--samples", options->samples_per_texel, "Paths per texel")->check(CLI::Range(1u, 1u << 20));
    command->add_option("--texels-per-metre", options->density, "0: the preset's budget")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--max-page", options->max_page, "Largest page edge")->check(CLI::Range(64u, 16384u));
    command->add_flag("--preview", options->preview, "Of preset preview: denoised");
    command->add_option("--threads", options->threads, "1 to 256")->check(CLI::Range(1u, 256u));
    command->add_option("--pictures", options->pictures, "Folder for the pages of each method");
    command->add_option("--hold", options->solver.hold, "Weight that keeps baked texels")->check(CLI::PositiveNumber);
    command->add_option("--iterations", options->solver.iterations, "Of the solver, at most");
    command->add_option("--rounds", options->solver.rounds, "Of the solver, at most");
    command->add_option("--tolerance", options->solver.tolerance, "Of the solver")->check(CLI::PositiveNumber);
    command->add_option("--per-texel", options->solver.samples_per_texel, "Points along seams")
        ->check(CLI::PositiveNumber);
    command->callback([options] { run(*options); });
}

}  // namespace lumel::bench
