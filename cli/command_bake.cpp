// lumel bake: the main job.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/try.h"
#include "command.h"
#include "interrupt.h"
#include "io/page_files.h"
#include "io/partial_folder.h"
#include "lumel/bake_folder.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string scene, output, max_memory, progress;
    std::string integrator = "auto", guide = "auto", stop, denoise = "auto", seams = "off";
    std::uint32_t views = 2, view_samples = 32;
    std::optional<double> error, confidence, time;
    BakeOptions values;
    TexelOptions texels;
    LightOptions light;
};

Result<BakeOptions> read_options(const Options& options) {
    BakeOptions out = options.values;
    LUMEL_TRY_STATUS(options.light.read(out));
    LUMEL_TRY_STATUS(options.texels.read(out));
    if (!options.max_memory.empty()) {
        LUMEL_TRY(out.max_memory_bytes, parse_bytes(options.max_memory, "--max-memory"));
    }
    if (options.denoise != "auto") out.denoise = options.denoise == "on";
    out.seams = options.seams == "on";
    // An error to reach is asked for by its name alone.
    const std::string stop = !options.stop.empty() ? options.stop : options.error ? "error" : "fixed";
    if (stop == "fixed" && (options.error || options.confidence))
        return Error{ErrorCode::usage,
                     options.error ? "--error does not go with --stop fixed" : "--confidence needs --error",
                     {},
                     "a fixed number of samples has no error to stop at"};
    if (stop != "fixed" && options.time)
        return Error{ErrorCode::usage,
                     "--time does not go with --error or --stop " + stop,
                     {},
                     "--time finds the number of samples that all texels take; --samples bounds that of --error"};
    out.time_seconds = options.time.value_or(out.time_seconds);
    out.error = options.error.value_or(out.error);
    out.confidence = options.confidence.value_or(out.confidence);
    out.integrator = options.integrator == "cells"   ? Integrator::cells
                     : options.integrator == "paths" ? Integrator::paths
                                                     : Integrator::automatic;
    out.guide = options.guide != "off";
    out.stop = stop == "flux" ? StopRule::flux : stop == "error" ? StopRule::error : StopRule::fixed;
    return out;
}

// Where to look first.
void print_files(const std::filesystem::path& folder, std::uint32_t views) {
    std::printf("lit scene: %s\npictures: ", (folder / kSceneFile).c_str());
    if (views > 0)
        std::printf("%s (path-traced beside baked), ", (folder / (kViewStem + std::string("*.png"))).c_str());
    std::printf("%s\n", (folder / "preview_atlas_*.png").c_str());
}

// What was reached of --error and --time.
void print_reached(const BakeReport& report, const BakeOptions& options) {
    if (options.time_seconds > 0.0)
        std::printf("%u samples per texel for the time: --samples %u gives the same bits\n", report.samples_per_texel,
                    report.samples_per_texel);
    if (!std::isfinite(report.share_within_error)) return;
    std::printf("%.1f %% of the texels are within %g at confidence %g; %.0f samples per texel of at most %u\n",
                100.0 * report.share_within_error, options.error, options.confidence,
                static_cast<double>(report.samples) / static_cast<double>(std::max<std::uint64_t>(1, report.texels)),
                report.samples_per_texel);
    const double rest = 1.0 - report.share_within_error - report.share_unlit - report.share_out_of_samples;
    std::printf("of the others %.1f %% took all samples, %.1f %% are black, %.1f %% stopped sooner\n",
                100.0 * report.share_out_of_samples, 100.0 * report.share_unlit, 100.0 * std::max(0.0, rest));
}

void print_collapsed(const BakeReport& report) {
    std::printf("%llu of %llu charts are even enough to be as small as can be\n",
                static_cast<unsigned long long>(report.collapsed_charts),
                static_cast<unsigned long long>(report.charts));
}

void print_summary(const BakeReport& report, const std::string& folder, bool is_denoised) {
    std::printf("%s: %llu texels on %zu page%s, %llu charts", folder.c_str(),
                static_cast<unsigned long long>(report.texels), report.pages.size(),
                report.pages.size() == 1 ? "" : "s", static_cast<unsigned long long>(report.charts));
    // A kept layout has a density of its own everywhere.
    if (report.texels_per_metre > 0.0) std::printf(", %.1f texels/m", report.texels_per_metre);
    if (report.cells > 0) std::printf(", %llu cells", static_cast<unsigned long long>(report.cells));
    std::printf("\n");
    std::printf("%.1f Mrays at %.2f Mrays/s, %.0f %% of thread time in %s; ", 1e-6 * static_cast<double>(report.rays),
                1e-6 * report.rays_per_second,
                report.trace_wall_seconds > 0.0
                    ? 100.0 * report.tracer_seconds / (report.trace_wall_seconds * report.threads)
                    : 0.0,
                report.tracer.c_str());
    if (std::isfinite(report.estimated_nrmse))
        std::printf("estimated nRMSE %.4f%s (noise over light: unseen at 0.01, plain at 0.1); ", report.estimated_nrmse,
                    is_denoised ? " before denoising" : "");
    else
        std::printf("nRMSE unknown from single paths; ");
    if (std::isfinite(report.cell_bias) && std::isfinite(report.cell_bias_error))
        std::printf("bias by cells %+.2f +- %.2f %% of the light; ", 100.0 * report.cell_bias,
                    100.0 * report.cell_bias_error);
    std::printf("peak memory %llu MB\n", static_cast<unsigned long long>(report.peak_memory_bytes >> 20));
}

Status run(const Options& options) {
    LUMEL_TRY(BakeOptions bake_options, read_options(options));
    RunContext run_context(bake_options.threads, options.progress);
    Context& context = run_context.get();
    LUMEL_TRY(const LoadedScene loaded, load_lit_scene(options.scene, bake_options, context));
    FolderOptions folder;
    folder.views = options.views;
    folder.view_samples = options.view_samples;
    folder.begun = [&](const std::filesystem::path& partial) {
        run_context.interrupt().set_cleaner([partial] { remove_while_written(partial); });
    };
    folder.may_appear = [&] { return run_context.interrupt().begin_commit(); };
    LUMEL_TRY(const BakeReport report, bake_to_folder(loaded, bake_options, options.output, folder, context));
    run_context.finish();
    print_summary(report, options.output, bake_options.denoise.value_or(preset_values(bake_options.preset).denoise));
    if (bake_options.atlas) print_kept(report.kept_charts, report.charts, *bake_options.atlas);
    if (bake_options.collapse > 0.0) print_collapsed(report);
    print_reached(report, bake_options);
    print_files(options.output, options.views);
    return success();
}

}  // namespace

Run add_bake(CLI::App& app) {
    auto options = std::make_shared<Options>();
    BakeOptions& values = options->values;
    app.add_option("SCENE", options->scene, "glTF scene: .glb or .gltf")->required();
    app.add_option("-o,--output", options->output, "Output folder; appears whole or not at all")->required();
    options->texels.declare(app);
    app.add_option("--views", options->views, "Camera views rendered beside the truth")
        ->check(CLI::Range(0u, kMostViews));

    app.add_option("--view-samples", options->view_samples, "Paths per pixel of those views")
        ->check(CLI::Range(1u, 1u << 16));

    const std::string texels = "Texels";
    app.add_option("--denoise", options->denoise, "auto (previews only), on or off: smooth the noise on the surface")
        ->check(CLI::IsMember({"auto", "on", "off"}))
        ->group(texels);
    app.add_option("--dilate", values.dilate, "Rings of texels filled around charts")
        ->check(CLI::Range(0u, 64u))
        ->group(texels);
    app.add_option("--seams", options->seams, "on or off: both sides of a seam show the same light")
        ->check(CLI::IsMember({"on", "off"}))
        ->group(texels);

    app.add_option("--collapse", values.collapse,
                   "Charts whose light spreads by less than this share of its mean become as small as can be (0: none)")
        ->check(between(0.0, 1.0))
        ->group(texels);

    const std::string transport = "Transport";
    app.add_option("--ao-distance", values.ao_distance,
                   "Reach of ambient occlusion in metres (0: a tenth of the diagonal)")
        ->check(not_negative())
        ->group(transport);
    app.add_option("--integrator", options->integrator,
                   "auto, cells (paths end at a cache of the surfaces' light) or paths (brute force)")
        ->check(CLI::IsMember({"auto", "cells", "paths"}))
        ->group(transport);
    app.add_option("--guide", options->guide,
                   "auto (with cells: rays and the choice of lamps follow what nearby texels have seen) or off")
        ->check(CLI::IsMember({"auto", "off"}))
        ->group(transport);
    app.add_option("--time", options->time,
                   "Seconds of tracing to end within (denoising, files, views come on top): as many samples as fit")
        ->default_str("off")
        ->check(between(1e-3, 1e7))
        ->group(transport);
    app.add_option("--error", options->error,
                   "Relative error of a texel to stop at, for example 0.05; --samples bounds its paths")
        ->default_str("off")
        ->check(between(1e-6, 1.0))
        ->group(transport);
    app.add_option("--confidence", options->confidence, "Confidence of --error")
        ->default_str("0.95")
        ->check(between(0.5, 0.9999))
        ->group(transport);
    app.add_option("--stop", options->stop,
                   "fixed: every texel takes --samples; error: each stops at --error by what its neighbours measured; "
                   "flux: by its own samples (published rule, biased on rare light)")
        ->default_str("fixed; error with --error")
        ->check(CLI::IsMember({"fixed", "error", "flux"}))
        ->group(transport);
    app.add_flag("--two-sided", values.two_sided, "Light both sides of double-sided surfaces")->group(transport);
    app.add_option("--max-memory", options->max_memory, "Ceiling such as 4G; pages shrink to fit it")
        ->default_str("none")
        ->check(not_empty());
    options->light.declare(app, "the preset's");
    declare_progress(app, options->progress);
    return [options] {
        const Status status = run(*options);
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "bake");
    };
}

}  // namespace lumel::cli
