// How many samples a bake takes, and cells for how many: by its options, or by a trial where it has a time to keep.
#pragma once

#include <cstdint>

#include "lumel/options.h"
#include "path/path_integrator.h"

namespace lumel {

// Samples for which surface cells are made: as fine as in a bake of a fixed number of samples with about that error.
// 0: no cells.
std::uint32_t samples_for_cells(const BakeOptions& options, const PathOptions& path);

// What the trial needs to know of a bake; `texels` are those of page 0.
struct TimePlan {
    const ChartSet& charts;
    const Atlas& atlas;
    const TexelBuffer& texels;
    double elapsed_seconds;  // of this bake
    double raster_seconds;   // that page 0 took
    bool has_cells;          // that paths end at
};

// The largest number of samples, of those between kFewestTimedSamples and path.samples that are powers of two or half
// as much again, that ends within options.time_seconds. Lights the coarsest cells and gathers some blocks with them to
// know what a path costs. Diagnostics: "time-too-short" where not even the fewest do. What comes after tracing is not
// planned for. Error: cancelled.
inline constexpr std::uint32_t kFewestTimedSamples = 32;
Result<std::uint32_t> samples_within_time(const TimePlan& plan, const BakeOptions& options, const Transport& transport,
                                          const PathOptions& path, Context& context);

}  // namespace lumel
