// lumel check: is a bake fit to ship? A gate for build farms.
#include <algorithm>
#include <cstdio>

#include "base/try.h"
#include "check/verdict.h"
#include "command.h"
#include "io/check_report.h"
#include "io/image_io.h"
#include "io/read_bake.h"
#include "trace/tracer.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string folder, html, progress;
    bool json = false;
    std::uint32_t threads = 0;
    CheckLimits limits;
    TexelCheckOptions texels;
};

void print(const SeamContrast& open, const SeamContrast& parted) {
    if (open.samples == 0)
        std::printf("seams: no seams to measure");
    else
        std::printf("seams: %llu samples over %.1f m", static_cast<unsigned long long>(open.samples), open.metres);
    if (parted.samples > 0) std::printf(", and %.1f m that something stands on", parted.metres);
    std::printf("\n");
}

// One line per figure: those with a limit have a verdict, and where it is FAILED the option that would allow it.
void print(const Finding& f) {
    const double unit = f.is_share ? 100.0 : 1.0;
    std::printf("%s %-18s %10.*f%s",
                !f.has_limit() ? "      "
                : f.passed()   ? "ok    "
                               : "FAILED",
                f.name.c_str(), f.is_share ? 4 : 0, unit * f.value, f.is_share ? " %" : "  ");
    if (f.has_limit()) {
        std::printf("  (at most %g%s", unit * f.limit, f.is_share ? " %" : "");
        if (!f.passed()) std::printf(", by %s %g", f.option.c_str(), f.limit);
        std::printf(")");
    }
    std::printf("  %s", f.text.c_str());
    if (!f.passed() && !f.places.empty())
        std::printf("; first at page %u texel (%u, %u)", f.places[0].page, f.places[0].x, f.places[0].y);
    std::printf("\n");
}

void print_all(const CheckReport& report) {
    print(report.seams.open, report.seams.parted);
    for (const Finding& f : report.findings)
        if (f.is_measured) print(f);
    for (const Diagnostic& w : report.remarks.warnings)
        std::printf("the bake warned of [%s], %llu times: %s\n", w.code.c_str(),
                    static_cast<unsigned long long>(w.count), w.message.c_str());
    if (const std::string text = advice(report); !text.empty()) std::printf("advice: %s\n", text.c_str());
    std::printf("%s\n", verdict(report.findings).c_str());
}

// Whether all limits are kept.
Result<bool> run_in(const Options& options, Context& context) {
    LUMEL_TRY(const BakeOnDisk disk, read_bake(options.folder, context));
    LUMEL_TRY(const WorldGeometry geometry, flatten(disk.scene, context));
    LUMEL_TRY(const auto tracer, make_embree_tracer(geometry, SurfaceReader(disk.scene, geometry), context));
    LUMEL_TRY(const SeamCheck seams, check_seams(disk.bake, {}, *tracer, context));
    LUMEL_TRY(const TexelCheck texels, check_texels(disk.bake, options.texels, context));
    const std::vector<Finding> findings = judge(seams, texels, options.limits);
    LUMEL_TRY(const BakeRemarks remarks, read_remarks(options.folder));
    const CheckReport report{disk.bake, seams, texels, findings, remarks};
    if (!options.html.empty()) {
        const std::string html = check_html(report, options.folder);
        LUMEL_TRY_STATUS(write_file(options.html, std::as_bytes(std::span(html))));
    }
    if (options.json)
        std::fputs(check_json(report).c_str(), stdout);
    else
        print_all(report);
    return std::ranges::all_of(findings, &Finding::passed);
}

int run(const Options& options) {
    RunContext context(options.threads, options.progress);
    const Result<bool> passed = run_in(options, context.get());
    context.finish();
    if (!passed.ok()) return fail(passed.error(), "check");
    return passed.value() ? kDone : kFailed;
}

}  // namespace

Run add_check(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CheckLimits& limits = options->limits;
    app.add_option("DIR", options->folder, "Output folder of lumel bake")->required();
    app.add_flag("--json", options->json, "Print JSON instead of text");
    app.add_option("--html", options->html, "Write a page with pictures of what was found to this file")
        ->check(not_empty());
    const std::string gate = "At most (-1: any)";
    const auto limit = [&](const char* name, double& value, const char* what) {
        app.add_option(name, value, what)->check(between(-1.0, 1e12))->group(gate);
    };
    limit("--max-seam-p99", limits.seam_p99, "Contrast across seams, 99th percentile of their length, of 1");
    limit("--max-seam-visible", limits.seam_visible, "Share of their length above 1 % contrast, of 1");
    limit("--max-invalid", limits.invalid, "Share of texels without a valid sample, of 1");
    limit("--max-unconverged", limits.unconverged, "Share of texels noisier than --noisy, of 1");
    limit("--max-outliers", limits.outliers, "Share of the surface with outlying density, of 1");
    limit("--max-not-finite", limits.not_finite, "Texels that hold no number");
    limit("--max-black", limits.black, "Black texels amid lit ones");
    limit("--max-uncovered", limits.uncovered, "Triangles that look up empty texels");
    limit("--max-overlaps", limits.overlaps, "Pairs of triangles on one place of a page");
    app.add_option("--noisy", options->texels.noisy, "Standard error over light from which a texel is unconverged")
        ->check(between(1e-6, 1e6));
    app.add_option("--outlier", options->texels.outlier, "Times the median density, or below it")
        ->check(between(1.0, 1e6));
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    declare_progress(app, options->progress);
    return [options] { return run(*options); };
}

}  // namespace lumel::cli
