#include "chart/kept_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "chart/chart_mask.h"
#include "chart/mesh_charts.h"

namespace lumel {
namespace {

// Calls visit(instance, chart, texel) for every texel of the page that a chart of a lightmap instance can touch.
template <class Visit>
void for_each_texel(const Scene& scene, const ChartSet& charts, AtlasPage page, const Visit& visit) {
    const TexelMap map{double(page.width), double(page.height), 0.0, 0.0};
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        if (scene.instances[i].node_class != NodeClass::lightmap) continue;
        const MeshCharts& mesh = charts.meshes[scene.instances[i].mesh];
        for (const std::uint32_t t : mesh.order)
            for_each_mask_span(mesh.uv[t], map, page.width, page.height,
                               [&](std::uint32_t y, std::uint32_t x0, std::uint32_t x1) {
                                   for (std::uint32_t x = x0; x < x1; ++x)
                                       visit(i, mesh.chart_of_triangle[t], std::size_t{y} * page.width + x);
                               });
    }
}

}  // namespace

AtlasPage kept_page(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                    const ChartOptions& options) {
    if (options.resolution_width != 0) return {options.resolution_width, options.resolution_height};
    double world = 0.0, uv = 0.0;
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
        const WorldTriangle& triangle = geometry.triangles[t];
        const Instance& instance = scene.instances[triangle.instance];
        if (instance.node_class != NodeClass::lightmap) continue;
        const MeshCharts& mesh = charts.meshes[instance.mesh];
        if (mesh.chart_of_triangle[triangle.mesh_triangle] == kNone) continue;
        world += geometry.area(t);
        uv += 0.5 * std::abs(uv_cross(mesh.uv[triangle.mesh_triangle]));
    }
    const double texels = options.texels_per_metre > 0.0 ? world * options.texels_per_metre * options.texels_per_metre
                                                         : options.texel_budget;
    const double edge = uv > 0.0 ? std::ceil(std::sqrt(texels / uv) / 4.0) * 4.0 : 4.0;
    const auto size = static_cast<std::uint32_t>(std::clamp(edge, 4.0, static_cast<double>(options.max_page)));
    return {size, size};
}

void merge_charts_sharing_texels(const Scene& scene, ChartSet& charts, AtlasPage page) {
    std::vector<std::uint32_t> first(charts.meshes.size() + 1, 0);  // charts of all meshes in one row
    for (std::size_t m = 0; m < charts.meshes.size(); ++m)
        first[m + 1] = first[m] + static_cast<std::uint32_t>(charts.meshes[m].charts.size());
    std::vector<std::uint32_t> root(first.back());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t c) {
        while (root[c] != c) c = root[c] = root[root[c]];
        return c;
    };
    // The first chart at each texel. Of two meshes the first keeps the texel: nodes are never merged.
    std::vector<std::uint32_t> owner(std::size_t{page.width} * page.height, kNone);
    for_each_texel(scene, charts, page, [&](std::uint32_t i, std::uint32_t chart, std::size_t texel) {
        const std::uint32_t mesh = scene.instances[i].mesh, self = first[mesh] + chart;
        std::uint32_t& o = owner[texel];
        if (o == kNone) o = self;
        if (o == self || o < first[mesh] || o >= first[mesh + 1]) return;
        const std::uint32_t a = find(o), b = find(self);
        root[std::max(a, b)] = std::min(a, b);
    });
    for (std::size_t m = 0; m < charts.meshes.size(); ++m) {
        MeshCharts& mesh = charts.meshes[m];
        std::vector<std::uint32_t> number(mesh.charts.size(), kNone);
        std::uint32_t count = 0;
        for (std::uint32_t c = 0; c < mesh.charts.size(); ++c) {
            const std::uint32_t r = find(first[m] + c) - first[m];
            number[c] = r == c ? count++ : number[r];
        }
        if (count == mesh.charts.size()) continue;
        for (std::uint32_t& c : mesh.chart_of_triangle)
            if (c != kNone) c = number[c];
        index_charts(mesh);
    }
}

void report_bleeding(const Scene& scene, const ChartSet& charts, AtlasPage page, Diagnostics& diagnostics) {
    std::vector<std::uint32_t> owner(std::size_t{page.width} * page.height, kNone);
    std::vector<bool> told(owner.size(), false);
    for_each_texel(scene, charts, page, [&](std::uint32_t i, std::uint32_t, std::size_t texel) {
        if (owner[texel] == kNone) owner[texel] = i;
        if (owner[texel] == i || told[texel]) return;
        told[texel] = true;
        diagnostics.add("uv-bleeding",
                        "texels are shared by charts of different nodes under bilinear filtering; the kept layout has "
                        "too little padding for this page size",
                        "texel (" + std::to_string(texel % page.width) + ", " + std::to_string(texel / page.width) +
                            "): node '" + scene.instances[owner[texel]].name + "' and node '" +
                            scene.instances[i].name + "'");
    });
}

}  // namespace lumel
