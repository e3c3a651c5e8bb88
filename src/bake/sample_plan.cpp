#include "bake/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/stopwatch.h"
#include "base/try.h"
#include "path/cell_bias.h"
#include "path/gather_page.h"
#include "path/light_cells.h"
#include "path/texel_blocks.h"

namespace lumel {
namespace {

constexpr std::uint32_t kFewestSamplesForCells = 8;  // fewer cost less than the cells would
constexpr std::uint32_t kFewestBouncesForCells = 8;  // fewer are counted to the last, which cells do not

bool uses_cells(const BakeOptions& options, const PathOptions& path) {
    if (path.bounces == 0) return false;
    if (options.integrator == Integrator::automatic)
        return path.samples >= kFewestSamplesForCells && path.bounces >= kFewestBouncesForCells;
    return options.integrator == Integrator::cells;
}

double pixels_of(const Atlas& atlas) {
    double pixels = 0.0;
    for (const AtlasPage& page : atlas.pages) pixels += static_cast<double>(page.width) * page.height;
    return pixels;
}

// Seconds that cells for so many samples take, by those of the trial.
struct CellCost {
    double cells = 0.0, edge = 1.0, seconds_per_path = 0.0;

    [[nodiscard]] double seconds(const Atlas& atlas, std::uint32_t samples) const {
        const double finer = edge / texels_per_cell(atlas, samples);
        const double count = cells * finer * finer;
        return count * static_cast<double>(links_per_cell(static_cast<std::size_t>(count), samples)) * seconds_per_path;
    }
};

constexpr std::size_t kTrialTexels = 2048;
constexpr std::uint32_t kTrialSamples = 64;

}  // namespace

std::uint32_t samples_for_cells(const BakeOptions& options, const PathOptions& path) {
    if (!uses_cells(options, path)) return 0;
    if (options.stop != StopRule::error) return path.samples;
    // 256 samples leave a room some 5 % of error.
    constexpr double kSamples = 256.0, kError = 0.05, kLeast = 64.0, kMost = 4096.0;
    const double alike = kSamples * (kError / options.error) * (kError / options.error);
    return std::min(path.samples, static_cast<std::uint32_t>(std::clamp(alike, kLeast, kMost)));
}

Result<std::uint32_t> samples_within_time(const TimePlan& plan, const BakeOptions& options, const Transport& transport,
                                          const PathOptions& path, Context& context) {
    const Stopwatch trial;
    CellCost cost;
    std::optional<SurfaceCells> cells;
    Transport through = transport;
    PathOptions trial_path = path;
    if (plan.has_cells) {
        trial_path.samples = kFewestTimedSamples;
        LUMEL_TRY(cells, make_lit_cells(plan.charts, plan.atlas, transport, trial_path, context));
        const auto count = std::max<std::size_t>(1, cells->size());
        cost = {static_cast<double>(count), texels_per_cell(plan.atlas, kFewestTimedSamples),
                trial.seconds() / static_cast<double>(count * links_per_cell(count, kFewestTimedSamples))};
        through.cells = &*cells;
        trial_path.guided = trial_path.lights_learned = options.guide;
    }
    // Blocks from all over the page.
    trial_path.samples = kTrialSamples;
    trial_path.stop = StopRule::fixed;
    const TexelBlocks some = spread_blocks(make_texel_blocks(plan.texels, 0, plan.texels.size()), kTrialTexels);
    const Stopwatch gathering;
    LUMEL_TRY(const RadianceSums sums,
              gather_blocks(some, plan.texels, plan.charts, plan.atlas, through, trial_path, context));
    const double texels_of_trial = std::max<double>(1.0, static_cast<double>(some.texels.size()));
    const double seconds_per_sample =
        gathering.seconds() * (plan.has_cells ? 1.0 + kCellBiasWork : 1.0) / (texels_of_trial * kTrialSamples);

    const double pages = pixels_of(plan.atlas) / (static_cast<double>(plan.texels.width) * plan.texels.height);
    const double texels = pages * static_cast<double>(plan.texels.size());
    const double left = options.time_seconds - plan.elapsed_seconds - trial.seconds() - plan.raster_seconds * pages;
    const auto seconds_for = [&](std::uint32_t n) {
        return texels * n * seconds_per_sample + (cells ? cost.seconds(plan.atlas, n) : 0.0);
    };
    std::uint32_t chosen = std::min(kFewestTimedSamples, path.samples);
    if (seconds_for(chosen) > left)
        context.diagnostics.add("time-too-short",
                                "--time is too short for " + std::to_string(chosen) +
                                    " samples per texel, the fewest that are taken: lower " +
                                    (options.resolution_width > 0 ? "--resolution" : "--texels-per-metre"),
                                transport.scene.source);
    for (std::uint32_t power = kFewestTimedSamples; power <= path.samples; power *= 2)
        for (const std::uint32_t n : {power, power + power / 2})
            if (n <= path.samples && seconds_for(n) <= left) chosen = std::max(chosen, n);
    return chosen;
}

}  // namespace lumel
