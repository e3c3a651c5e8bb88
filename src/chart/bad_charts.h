// Which instances their charts serve so badly that they are better off without texels: what is all leaves, blades or
// crumbs falls into thousands of charts, each of which takes 2 x 2 texels for a surface far smaller than one.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"

namespace lumel {

// The charts of one lightmap instance at a density.
struct ChartWorth {
    std::uint32_t instance = 0, charts = 0;
    double texels = 0.0;    // what its surface is worth; its charts take four each or more
    double smallest = 0.0;  // share of its surface that lies in charts of 2 x 2 texels
    [[nodiscard]] double texels_per_chart() const { return texels / charts; }
};

// All lightmap instances with charts of our own, in order, at the density asked for; where none is, at that which the
// budget or the one page gives to the bare surface. Charts make no difference to it: those of one instance never decide
// about another.
std::vector<ChartWorth> chart_worths(const Scene& scene, const ChartSet& charts, const ChartOptions& options);

// The documented rule (docs/stages/charts.md): at least 256 charts, on average worth less than 1/16 of a texel, and
// most of the surface in charts of the smallest size.
bool is_bad(const ChartWorth& worth);

// Fills `demoted`. Diagnostic "bad-charts": the nodes and their figures.
void demote_bad_charts(const Scene& scene, const ChartOptions& options, ChartSet& charts, Diagnostics& diagnostics);

}  // namespace lumel
