#include "seam/border_edges.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace lumel {
namespace {

struct MeshEdge {
    std::uint32_t chart, triangle, corner;
    std::array<Vec2, 2> uv;  // the lesser end first, so that both sides of an inner edge are equal

    [[nodiscard]] auto key() const { return std::tuple(chart, uv[0].x, uv[0].y, uv[1].x, uv[1].y); }
};

bool is_before(Vec2 a, Vec2 b) { return std::tuple(a.x, a.y) < std::tuple(b.x, b.y); }

// Edges that only one triangle of their chart has at their place of the layout.
std::vector<MeshEdge> border_of(const MeshCharts& charts) {
    std::vector<MeshEdge> edges;
    edges.reserve(3 * charts.order.size());
    for (const std::uint32_t t : charts.order)
        for (std::uint32_t k = 0; k < 3; ++k) {
            Vec2 a = charts.uv[t][k], b = charts.uv[t][(k + 1) % 3];
            if (is_before(b, a)) std::swap(a, b);
            edges.push_back({charts.chart_of_triangle[t], t, k, {a, b}});
        }
    std::ranges::sort(edges, [](const MeshEdge& a, const MeshEdge& b) {
        return std::tuple(a.key(), a.triangle, a.corner) < std::tuple(b.key(), b.triangle, b.corner);
    });
    std::vector<MeshEdge> border;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end].key() == edges[i].key()) ++end;
        if (end == i + 1) border.push_back(edges[i]);
    }
    std::ranges::sort(border, [](const MeshEdge& a, const MeshEdge& b) {
        return std::tuple(a.triangle, a.corner) < std::tuple(b.triangle, b.corner);
    });
    return border;
}

Vec3 vertex_normal(const WorldGeometry& geometry, std::uint32_t triangle, std::uint32_t corner) {
    return geometry.shading_normal(triangle, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f);
}

}  // namespace

std::vector<BorderEdge> find_border_edges(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                          const Atlas& atlas) {
    std::vector<std::vector<MeshEdge>> borders(charts.meshes.size());
    std::vector<std::uint8_t> known(charts.meshes.size());
    std::vector<BorderEdge> out;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        if (!charts.gets_texels(scene, i)) continue;
        const std::uint32_t mesh = scene.instances[i].mesh;
        if (known[mesh] == 0) borders[mesh] = border_of(charts.meshes[mesh]);
        known[mesh] = 1;
        for (const MeshEdge& edge : borders[mesh]) {
            const std::uint32_t triangle = geometry.first_triangle[i] + edge.triangle, k = edge.corner;
            const auto uv = atlas.triangle_uv(charts, geometry, scene, triangle);
            if (uv.page == kNone) continue;
            const std::array<Vec3, 3> corners = geometry.corners(triangle);
            const Vec3 from = corners[k], to = corners[(k + 1) % 3];
            const Vec3 along = normalize_or(to - from, {});
            if (along == Vec3{}) continue;
            const Vec3 across = corners[(k + 2) % 3] - from;
            out.push_back({from, to, vertex_normal(geometry, triangle, k),
                           vertex_normal(geometry, triangle, (k + 1) % 3),
                           normalize_or(across - along * dot(across, along), {}), uv.texels[k], uv.texels[(k + 1) % 3],
                           uv.page, triangle});
        }
    }
    return out;
}

std::uint64_t count_border_edges(const Scene& scene, const ChartSet& charts) {
    std::vector<std::uint64_t> instances(charts.meshes.size());
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
        if (charts.gets_texels(scene, i)) ++instances[scene.instances[i].mesh];
    std::uint64_t count = 0;
    for (std::size_t m = 0; m < instances.size(); ++m)
        if (instances[m] > 0) count += instances[m] * border_of(charts.meshes[m]).size();
    return count;
}

}  // namespace lumel
