#include "chart/mesh_charts.h"

#include <algorithm>

namespace lumel {

void index_charts(MeshCharts& charts) {
    std::uint32_t count = 0;
    for (const std::uint32_t c : charts.chart_of_triangle)
        if (c != kNone) count = std::max(count, c + 1);
    charts.charts.assign(count, {});
    for (const std::uint32_t c : charts.chart_of_triangle)
        if (c != kNone) ++charts.charts[c].count;
    std::uint32_t first = 0;
    for (Chart& chart : charts.charts) {
        chart.first = first;
        first += chart.count;
        chart.count = 0;
    }
    charts.order.resize(first);
    for (std::uint32_t t = 0; t < charts.chart_of_triangle.size(); ++t) {
        if (charts.chart_of_triangle[t] == kNone) continue;
        Chart& chart = charts.charts[charts.chart_of_triangle[t]];
        if (chart.count == 0) chart.min = chart.max = charts.uv[t][0];
        charts.order[chart.first + chart.count++] = t;
        for (const Vec2 p : charts.uv[t]) {
            chart.min = {std::min(chart.min.x, p.x), std::min(chart.min.y, p.y)};
            chart.max = {std::max(chart.max.x, p.x), std::max(chart.max.y, p.y)};
        }
    }
}

MeshCharts assemble_charts(std::size_t triangle_count, std::vector<FlatChart> flat) {
    std::sort(flat.begin(), flat.end(),
              [](const FlatChart& a, const FlatChart& b) { return a.triangles[0] < b.triangles[0]; });
    MeshCharts charts;
    charts.chart_of_triangle.assign(triangle_count, kNone);
    charts.uv.assign(triangle_count, {});
    for (std::uint32_t c = 0; c < flat.size(); ++c) {
        for (std::size_t i = 0; i < flat[c].triangles.size(); ++i) {
            charts.chart_of_triangle[flat[c].triangles[i]] = c;
            charts.uv[flat[c].triangles[i]] = flat[c].uv[i];
        }
    }
    index_charts(charts);
    return charts;
}

}  // namespace lumel
