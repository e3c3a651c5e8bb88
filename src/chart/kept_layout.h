// A scene-wide TEXCOORD_1 layout that is kept as it is: its page and what its charts do to each other there.
#pragma once

#include "chart/chart_set.h"

namespace lumel {

// The page: of the asked resolution, or square, its edge such that the mean density (over area) or the texel budget is
// met; a multiple of 4 within max_page.
AtlasPage kept_page(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                    const ChartOptions& options);

// Charts of one mesh that share texels of the page become one chart.
void merge_charts_sharing_texels(const Scene& scene, ChartSet& charts, AtlasPage page);

// Diagnostic "uv-bleeding": texels that charts of different nodes share under bilinear filtering.
void report_bleeding(const Scene& scene, const ChartSet& charts, AtlasPage page, Diagnostics& diagnostics);

}  // namespace lumel
