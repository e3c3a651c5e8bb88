// lumel check: is a bake fit to ship?
#include <cstdio>

#include "base/try.h"
#include "check/seam_check.h"
#include "command.h"
#include "io/read_bake.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string folder, progress;
    std::uint32_t threads = 0;
};

Status run_in(const Options& options, RunContext& run) {
    Context& context = run.get();
    LUMEL_TRY(const CheckedBake bake, read_bake(options.folder));
    LUMEL_TRY(const SeamCheck seams, check_seams(bake, {}, context));
    std::printf("seams: %llu samples, %.1f m, %.2f m above 1 %%; contrast median %.4f %%, P99 %.4f %%, largest %.2f %%\n",
                static_cast<unsigned long long>(seams.samples), seams.metres, seams.visible_metres,
                100.0 * seams.median, 100.0 * seams.p99, 100.0 * seams.largest);
    for (std::size_t i = 0; i < seams.worst.size() && i < 12; ++i) {
        const SeamDefect& d = seams.worst[i];
        std::printf("  %.1f %% at (%.2f, %.2f, %.2f) page %u texel (%.1f, %.1f) %s | %s\n", 100.0 * d.contrast,
                    double(d.position.x), double(d.position.y), double(d.position.z), d.page, double(d.texels.x),
                    double(d.texels.y), bake.instances[d.instance_a].c_str(), bake.instances[d.instance_b].c_str());
    }
    return success();
}

}  // namespace

Run add_check(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("DIR", options->folder, "Output folder of lumel bake")->required();
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    declare_progress(app, options->progress);
    return [options] {
        RunContext context(options->threads, options->progress);
        const Status status = run_in(*options, context);
        context.finish();
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "check");
    };
}

}  // namespace lumel::cli
