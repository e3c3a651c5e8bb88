// From lists of triangles with UVs to the MeshCharts of the interface.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"
#include "chart/parameterize.h"

namespace lumel {

// Fills order, charts and bounds from chart_of_triangle and uv, which are given. Chart ids must be dense.
void index_charts(MeshCharts& charts);

// Charts made by `parameterize`, in the order of their first triangles. Triangles in none of them get kNone.
MeshCharts assemble_charts(std::size_t triangle_count, std::vector<FlatChart> flat);

}  // namespace lumel
