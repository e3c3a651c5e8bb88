// The part of make_charts() that looks at a file's TEXCOORD_1: for telling what a bake would do with it.
#pragma once

#include "chart/chart_set.h"

namespace lumel {

// What make_charts() keeps of the meshes' TEXCOORD_1, and nothing else: meshes that would get charts of our own have
// none. Diagnostics and errors as there, but for those of own charts.
Result<ChartSet> charts_of_uv1(const Scene& scene, const WorldGeometry& geometry, const ChartOptions& options,
                               Context& context);

}  // namespace lumel
