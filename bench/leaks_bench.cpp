// The leak suite: texels of coarse bakes whose light is not that of the surface which lookups show it on. Beside the
// bake, the published method of one pushed sample a texel.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "bake/chart_options.h"
#include "bench.h"
#include "bench_scene.h"
#include "image/tonemap.h"
#include "io/image_io.h"
#include "leak_reference.h"
#include "leaks.h"
#include "load.h"
#include "lumel/bake.h"
#include "post/lightmap.h"
#include "seed_samples.h"

namespace lumel::bench {
namespace {

struct Options {
    std::vector<std::string> scenes;
    std::string pictures;
    std::uint32_t samples = 1024, paths = 4096;
    unsigned threads = 0;
    bool list = false, brute_force = false;
};

constexpr double kBar = 0.05, kDream = 0.02;  // of the scene's mean

// I of every pixel of page 0; nothing where the page holds none.
using PageLight = std::vector<std::optional<float>>;

PageLight page_light(const Lightmap& map) {
    PageLight out(map.texel_at.size());
    for (std::size_t at = 0; at < out.size(); ++at) {
        if (map.texel_at[at] == kNone) continue;
        float sum = 0.0f;
        for (const LayerMoments& layer : map.texels.layers[map.texel_at[at]]) sum += luminance(layer.irradiance);
        out[at] = sum;
    }
    return out;
}

BakeOptions bake_options(const Options& options) {
    BakeOptions out;
    out.texels_per_metre = samples::kLeakTexelsPerMetre;
    out.samples = options.samples;
    out.threads = options.threads;
    if (options.brute_force) out.integrator = Integrator::paths;
    return out;
}

PageLight baked(const BenchScene& bench, const Options& options, Context& context) {
    PageLight out;
    BakeSink sink;
    sink.page = [&](const Lightmap& map) {
        if (map.page == 0) out = page_light(map);
        return success();
    };
    need(bake(bench.scene, bake_options(options), sink, context));
    return out;
}

PageLight seeded(const BenchScene& bench, const Options& options, Context& context) {
    RadianceSums sums = gather_seed_samples(bench, options.samples, context);
    TexelSurface surface =
        need(read_texel_surface(bench.texels, bench.scene, bench.geometry, bench.charts, bench.atlas, context));
    return page_light(need(finish_page(bench.texels, std::move(sums), std::move(surface), {}, 2, context)));
}

struct Verdict {
    std::size_t read = 0, over_bar = 0, over_dream = 0;
    double worst = 0.0;
    std::vector<float> error;  // per pixel, of the scene's mean; negative: no lookup reads it
};

Verdict judge(const PageLight& light, const LeakReference& reference) {
    Verdict out;
    out.error.assign(light.size(), -1.0f);
    for (std::size_t at = 0; at < light.size(); ++at) {
        const AllowedLight& allowed = reference.pixels[at];
        if (allowed.means.empty()) continue;
        double nearest = 1.0;  // a pixel that holds nothing is black
        const double value = light[at] ? static_cast<double>(*light[at]) : 0.0;
        for (std::size_t k = 0; k < allowed.means.size(); ++k) {
            const double off = std::fabs(value - static_cast<double>(allowed.means[k])) / reference.scene_mean;
            nearest = k == 0 ? off : std::min(nearest, off);
        }
        ++out.read;
        out.over_bar += nearest > kBar;
        out.over_dream += nearest > kDream;
        out.worst = std::max(out.worst, nearest);
        out.error[at] = static_cast<float>(nearest);
    }
    return out;
}

// The page and its errors, one above the other: light in grey, texels above the bar in red, above the dream in yellow.
void draw(const BenchScene& bench, const LeakReference& reference, const PageLight& light, const Verdict& verdict,
          const std::filesystem::path& file) {
    constexpr std::uint32_t kZoom = 8;
    const std::uint32_t width = bench.texels.width, height = bench.texels.height;
    std::vector<std::uint8_t> bytes(std::size_t{width} * kZoom * height * kZoom * 2 * 3);
    for (std::uint32_t y = 0; y < 2 * height * kZoom; ++y)
        for (std::uint32_t x = 0; x < width * kZoom; ++x) {
            const std::size_t at = std::size_t{(y / kZoom) % height} * width + x / kZoom;
            const bool errors = y / kZoom >= height;
            Vec3 color{0.02f, 0.02f, 0.1f};
            if (light[at]) {
                const float grey = 0.5f * *light[at] / static_cast<float>(reference.scene_mean);
                color = {grey, grey, grey};
                if (errors) color = color * 0.4f;
            }
            if (errors && verdict.error[at] > kBar)
                color = {1, 0.05f, 0.05f};
            else if (errors && verdict.error[at] > kDream)
                color = {0.9f, 0.7f, 0.0f};
            else if (errors && verdict.error[at] < 0.0f)
                color = {0.0f, 0.0f, 0.15f};
            std::uint8_t* out = &bytes[(std::size_t{y} * width * kZoom + x) * 3];
            for (std::size_t c = 0; c < 3; ++c) out[c] = srgb8(std::min(1.0f, color[c]));
        }
    need(write_png(file, width * kZoom, 2 * height * kZoom, 3, bytes));
}

// Where the texels above the bar are, what they hold and what they may.
void list_leaks(const BenchScene& bench, const LeakReference& reference, const PageLight& light,
                const Verdict& verdict) {
    for (std::size_t at = 0; at < light.size(); ++at) {
        if (static_cast<double>(verdict.error[at]) <= kBar) continue;
        const std::uint32_t texel = bench.texels.texel_at[at];
        std::printf("#   %zu,%zu holds %.4f, may hold", at % bench.texels.width, at / bench.texels.width,
                    light[at] ? static_cast<double>(*light[at]) : 0.0);
        for (const float mean : reference.pixels[at].means) std::printf(" %.4f", static_cast<double>(mean));
        const Vec3 p = texel == kNone ? Vec3{} : bench.texels.position[texel];
        std::printf(" (%s%s) at %.3f,%.3f,%.3f\n", reference.pixels[at].own ? "own" : "read by others",
                    texel == kNone ? ", dilated" : "", static_cast<double>(p.x), static_cast<double>(p.y),
                    static_cast<double>(p.z));
    }
}

void run_leaks(const Options& options) {
    Context context(options.threads);
    std::printf(
        "scene,method,samples,texels_read,over_5_percent,over_2_percent,worst_percent,scene_mean,reference_sigma_"
        "percent\n");
    struct Total {
        const char* method;
        std::size_t failed = 0, over_bar = 0, over_dream = 0;
    };
    Total totals[] = {{"lumel"}, {"four_rays"}};
    for (samples::LeakScene& made : samples::leak_scenes()) {
        if (!options.scenes.empty() && std::ranges::find(options.scenes, made.name) == options.scenes.end()) continue;
        Scene scene = std::move(need(load_glb(made.glb.bytes(), made.name, context)).scene);
        scene.sky.color = made.sky;
        const BenchScene bench(made.name, std::move(scene), chart_options(bake_options(options)), context);
        if (bench.atlas.pages.size() != 1) throw std::runtime_error(made.name + " does not fit one page");
        const LeakReference reference = leak_reference(bench, made.hidden, options.paths, context);
        for (Total& total : totals) {
            const bool ours = &total == totals;
            const PageLight light = ours ? baked(bench, options, context) : seeded(bench, options, context);
            const Verdict verdict = judge(light, reference);
            total.failed += verdict.over_bar > 0;
            total.over_bar += verdict.over_bar;
            total.over_dream += verdict.over_dream;
            std::printf("%s,%s,%u,%zu,%zu,%zu,%.2f,%.4f,%.3f\n", made.name.c_str(), total.method, options.samples,
                        verdict.read, verdict.over_bar, verdict.over_dream, 100.0 * verdict.worst, reference.scene_mean,
                        100.0 * reference.sigma);
            if (options.list) list_leaks(bench, reference, light, verdict);
            std::fflush(stdout);
            if (!options.pictures.empty())
                draw(bench, reference, light, verdict,
                     std::filesystem::path(options.pictures) / (made.name + "_" + total.method + ".png"));
        }
    }
    for (const Total& total : totals)
        std::printf("all,%s,%u,,%zu,%zu,,,\n# %s fails in %zu scenes\n", total.method, options.samples, total.over_bar,
                    total.over_dream, total.method, total.failed);
}

}  // namespace

void add_leaks(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("leaks", "Coarse bakes of the leak suite against what each texel shows");
    command->add_option("scenes", o->scenes, "Names of scenes of the suite; none: all twelve");
    command->add_option("--samples", o->samples, "Per texel")->check(CLI::Range(1u, 1u << 20));
    command->add_option("--reference-paths", o->paths, "Per texel, of the reference")
        ->check(CLI::Range(512u, 1u << 24));
    command->add_option("--pictures", o->pictures, "Folder for PNG pictures: the page, and below it its leaks in red")
        ->check(CLI::ExistingDirectory);
    command->add_flag("--brute-force", o->brute_force, "Bake without surface cells");
    command->add_flag("--list", o->list, "Also list the texels above 5 percent");
    command->add_option("--threads", o->threads, "0: one per hardware thread");
    command->callback([o] { run_leaks(*o); });
}

}  // namespace lumel::bench
