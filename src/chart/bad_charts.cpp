#include "chart/bad_charts.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "chart/density.h"
#include "chart/where.h"

namespace lumel {
namespace {

// 256 charts take a thousand texels: below that there is nothing to win. A sixteenth of a texel is a sixty-fourth of
// what a chart takes. Objects with a body, however small and however many crumbs lie on it, keep their texels: most of
// their surface lies in larger charts.
constexpr std::uint32_t kManyCharts = 256;
constexpr double kWorthless = 1.0 / 16.0, kMost = 0.5;

double density_of(const ChartSet& charts, const std::vector<ChartInstance>& instances, const ChartOptions& options) {
    if (options.texels_per_metre > 0.0) return options.texels_per_metre;
    const double texels = options.resolution_width != 0
                              ? static_cast<double>(options.resolution_width) * options.resolution_height
                              : options.texel_budget;
    const double unit = texels_at_unit_density(charts, instances);
    return unit > 0.0 ? std::sqrt(texels / unit) : 0.0;
}

// Texels along a side are its length, rounded, plus one.
bool is_smallest(const Chart& chart, const ChartInstance& c, double density) {
    return (double{chart.max.x} - chart.min.x) * c.rate_x * density < 1.5 &&
           (double{chart.max.y} - chart.min.y) * c.rate_y * density < 1.5;
}

double uv_area(const MeshCharts& mesh, const Chart& chart) {
    double area = 0.0;
    for (std::uint32_t k = chart.first; k < chart.first + chart.count; ++k)
        area += 0.5 * std::abs(uv_cross(mesh.uv[mesh.order[k]]));
    return area;
}

std::string figures(const ChartWorth& worth) {
    char text[96];
    std::snprintf(text, sizeof text, "%u charts worth %.3f texels each, %.0f %% of the surface in the smallest",
                  worth.charts, worth.texels_per_chart(), 100.0 * worth.smallest);
    return text;
}

}  // namespace

std::vector<ChartWorth> chart_worths(const Scene& scene, const ChartSet& charts, const ChartOptions& options) {
    const std::vector<ChartInstance> instances = chart_instances(scene, charts);
    const double density = density_of(charts, instances, options);
    std::vector<ChartWorth> out;
    for (const ChartInstance& c : instances) {
        const MeshCharts& mesh = charts.meshes[c.mesh];
        if (mesh.from_uv1) continue;
        if (out.empty() || out.back().instance != c.instance) out.push_back({c.instance, 0, 0.0, 0.0});
        const Chart& chart = mesh.charts[c.chart];
        const double texels = uv_area(mesh, chart) * c.rate_x * c.rate_y * density * density;
        ++out.back().charts;
        out.back().texels += texels;
        if (is_smallest(chart, c, density)) out.back().smallest += texels;
    }
    for (ChartWorth& worth : out)
        if (worth.texels > 0.0) worth.smallest /= worth.texels;
    return out;
}

bool is_bad(const ChartWorth& worth) {
    return worth.charts >= kManyCharts && worth.texels_per_chart() < kWorthless && worth.smallest > kMost;
}

void demote_bad_charts(const Scene& scene, const ChartOptions& options, ChartSet& charts, Diagnostics& diagnostics) {
    charts.demoted.assign(scene.instances.size(), false);
    const std::vector<ChartWorth> worths = chart_worths(scene, charts, options);
    for (const ChartWorth& worth : worths) {
        if (scene.instances[worth.instance].class_is_asked || !is_bad(worth)) continue;
        charts.demoted[worth.instance] = true;
        diagnostics.add(
            "bad-charts",
            "nodes whose charts are many and far smaller than a texel became class volume, without texels; for "
            "texels all the same give them class lightmap in the sidecar, or a higher --texels-per-metre",
            node_and_mesh(scene, worth.instance) + ": " + figures(worth));
    }
}

}  // namespace lumel
