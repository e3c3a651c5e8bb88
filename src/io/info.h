// What Lumel sees in a scene, for people and for programs: `lumel info`.
#pragma once

#include <string>

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "lumel/scene.h"

namespace lumel {

// Several lines of text. `uv1`: what a bake would keep of the file's layouts (charts_of_uv1).
std::string describe(const Scene& scene, const ChartSet& uv1, const Diagnostics& diagnostics);
// The same as one JSON object.
std::string describe_json(const Scene& scene, const ChartSet& uv1, const Diagnostics& diagnostics);

}  // namespace lumel
