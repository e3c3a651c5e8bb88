// What the options of a bake ask of its charts.
#pragma once

#include "chart/chart_set.h"
#include "lumel/options.h"

namespace lumel {

// Borrows the layout to keep, where there is one.
ChartOptions chart_options(const BakeOptions& options);

}  // namespace lumel
