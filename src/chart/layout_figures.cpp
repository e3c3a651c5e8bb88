#include "chart/layout_figures.h"

#include <algorithm>
#include <cmath>

#include "chart/overlap.h"
#include "chart/parameterize.h"

namespace lumel {
namespace {

// Triangles of a mesh that are in charts and have area there.
std::vector<std::uint32_t> charted_triangles(const MeshCharts& charts) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t t = 0; t < charts.chart_of_triangle.size(); ++t)
        if (charts.chart_of_triangle[t] != kNone && uv_cross(charts.uv[t]) != 0.0) out.push_back(t);
    return out;
}

}  // namespace

PageFigures page_figures(const TexelOwners& owners) {
    PageFigures out;
    for (std::size_t i = 0; i < owners.triangle.size(); ++i) {
        out.used += owners.triangle[i] != kNone ? 1 : 0;
        out.covered += owners.covered[i];
    }
    if (!owners.triangle.empty())
        out.efficiency = static_cast<double>(out.used) / static_cast<double>(owners.triangle.size());
    return out;
}

std::vector<MipFigures> mip_figures(const Scene& scene, const ChartSet& charts, const Atlas& atlas,
                                    std::uint32_t page) {
    std::vector<MipFigures> out;
    for (std::uint32_t mip = 0; mip <= atlas.masks.mips; ++mip) {
        const std::vector<std::uint32_t> ids = chart_ids(scene, charts, atlas, page, mip);
        const auto free = static_cast<std::uint64_t>(std::ranges::count(ids, kNone));
        out.push_back({ids.size() - free, ids.size()});
    }
    return out;
}

std::vector<double> triangle_densities(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                       const Atlas& atlas) {
    std::vector<double> out(geometry.triangle_count(), 0.0);
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
        const double area = static_cast<double>(geometry.area(t));
        const Atlas::TriangleUv uv = atlas.triangle_uv(charts, geometry, scene, t);
        if (uv.page != kNone && area > 0.0) out[t] = std::sqrt(0.5 * std::abs(uv_cross(uv.texels)) / area);
    }
    return out;
}

std::vector<std::vector<double>> triangle_stretches(const Scene& scene, const ChartSet& charts) {
    std::vector<std::vector<double>> out(scene.meshes.size());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const MeshCharts& mesh = charts.meshes[m];
        if (mesh.charts.empty()) continue;
        out[m].assign(mesh.chart_of_triangle.size(), 1.0);
        for (std::uint32_t t = 0; t < out[m].size(); ++t)
            if (mesh.chart_of_triangle[t] != kNone) out[m][t] = l2_stretch(*scene.meshes[m], {t}, {mesh.uv[t]});
    }
    return out;
}

double layout_stretch(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts) {
    std::vector<double> of_mesh(scene.meshes.size(), 0.0);  // 0: not asked for yet
    double squares = 0.0, surface = 0.0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::uint32_t m = scene.instances[i].mesh;
        const MeshCharts& mesh = charts.meshes[m];
        if (!charts.gets_texels(scene, i) || mesh.charts.empty()) continue;
        const std::vector<std::uint32_t> triangles = charted_triangles(mesh);
        if (of_mesh[m] == 0.0) {
            std::vector<UvTriangle> uv;
            uv.reserve(triangles.size());
            for (const std::uint32_t t : triangles) uv.push_back(mesh.uv[t]);
            of_mesh[m] = l2_stretch(*scene.meshes[m], triangles, uv);
        }
        double area = 0.0;
        for (const std::uint32_t t : triangles)
            area += static_cast<double>(geometry.area(geometry.first_triangle[i] + t));
        squares += area * of_mesh[m] * of_mesh[m];
        surface += area;
    }
    return surface > 0.0 ? std::max(1.0, std::sqrt(squares / surface)) : 1.0;  // below 1 by rounding only
}

double mean_density(const WorldGeometry& geometry, const std::vector<double>& triangle_densities) {
    double texels = 0.0, surface = 0.0;
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
        if (triangle_densities[t] == 0.0) continue;
        const double area = static_cast<double>(geometry.area(t));
        texels += area * triangle_densities[t] * triangle_densities[t];
        surface += area;
    }
    return surface > 0.0 ? std::sqrt(texels / surface) : 0.0;
}

}  // namespace lumel
