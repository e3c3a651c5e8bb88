// Charts that no light reaches: the insides of walls, floors and roofs that are modelled as hollow solids. Texels there
// are black, or specks of what leaks in, and nobody sees them; they need not be as dense as those of lit surfaces.
#pragma once

#include <vector>

#include "chart/chart_set.h"
#include "path/path_integrator.h"

namespace lumel {

inline constexpr std::uint32_t kSealedPaths = 4096;  // of each chart that is looked at, spread over it
// With more that find light it is not sealed: one in a thousand.
inline constexpr std::uint32_t kSealedPathsThatFind = 4;
inline constexpr double kTexelsWorthSealing = 16.0;  // smaller charts would save nothing

// For ChartSet::sealed. A chart is sealed where no more than one in a thousand of the paths from it (all bounces, no
// cells) find any light, be it a lamp, the sun, the sky or a surface that glows. Looked at are charts that have
// kTexelsWorthSealing or more if `texel_budget` is spread evenly. Any number of threads gives the same. Error:
// cancelled.
Result<std::vector<std::vector<bool>>> find_sealed_charts(const ChartSet& charts, double texel_budget,
                                                          const Transport& transport, Context& context);

}  // namespace lumel
