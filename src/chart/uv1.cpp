#include "chart/uv1.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/union_find.h"
#include "chart/mesh_charts.h"

namespace lumel {
namespace {

constexpr float kBorder = 1e-5f;            // exporters write 1.0000001
constexpr double kFloor = 0x1p-20;          // rounding of coordinates in [0, 1]
constexpr double kMaxCollapsedArea = 1e-3;  // share of the surface that may have no area in UV: slivers, not faces

bool inside(Vec2 p) { return p.x >= -kBorder && p.y >= -kBorder && p.x <= 1.0f + kBorder && p.y <= 1.0f + kBorder; }

// In UV and in space.
struct Corner {
    Vec2 uv;
    Vec3 p;
    std::uint32_t triangle;
    [[nodiscard]] auto key() const { return std::tie(uv.x, uv.y, p.x, p.y, p.z); }
    bool operator<(const Corner& o) const { return key() != o.key() ? key() < o.key() : triangle < o.triangle; }
};

}  // namespace

std::vector<UvTriangle> uv1_triangles(const Mesh& mesh) {
    std::vector<UvTriangle> out;
    out.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) out.push_back({mesh.uv1[t[0]], mesh.uv1[t[1]], mesh.uv1[t[2]]});
    return out;
}

OverlapTolerance uv1_tolerance() { return {kFloor, 0x1p-14, 0.1}; }

std::string judge_uv1_coordinates(const Mesh& mesh, const std::vector<double>& areas) {
    if (mesh.uv1.empty()) return "it has none";
    double surface = 0.0, collapsed = 0.0;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        if (areas[t] == 0.0) continue;
        const Triangle& v = mesh.triangles[t];
        const UvTriangle uv{mesh.uv1[v[0]], mesh.uv1[v[1]], mesh.uv1[v[2]]};
        for (const Vec2 p : uv) {
            if (!is_finite(p)) return "it is not finite at triangle " + std::to_string(t);
            if (!inside(p)) return "it leaves [0, 1] at triangle " + std::to_string(t);
        }
        surface += areas[t];
        if (uv_altitude(uv) <= kFloor) collapsed += areas[t];
    }
    if (surface == 0.0) return "no triangle has area";
    if (collapsed > kMaxCollapsedArea * surface)
        return std::to_string(std::lround(100.0 * collapsed / surface)) + " % of the surface has no area in it";
    return "";
}

Uv1Verdict judge_uv1(const Mesh& mesh, const std::vector<double>& areas) {
    Uv1Verdict verdict;
    verdict.reason = judge_uv1_coordinates(mesh, areas);
    if (!verdict.fit()) return verdict;
    std::vector<UvTriangle> uv;
    std::vector<std::uint32_t> triangle;
    for (std::uint32_t t = 0; t < areas.size(); ++t) {
        if (areas[t] == 0.0) continue;
        const Triangle& v = mesh.triangles[t];
        uv.push_back({mesh.uv1[v[0]], mesh.uv1[v[1]], mesh.uv1[v[2]]});
        triangle.push_back(t);
    }
    const OverlapSearch search = find_overlaps(uv, uv1_tolerance(), kMaxOverlaps);
    for (const auto& [a, b] : search.pairs) verdict.overlaps.push_back({triangle[a], triangle[b]});
    if (!search.pairs.empty())
        verdict.reason = std::to_string(search.pairs.size()) + (search.complete ? "" : " or more") +
                         " pairs of triangles overlap in it";
    return verdict;
}

double uv1_scale(const Mesh& mesh, const std::vector<double>& areas) {
    double surface = 0.0, uv_area = 0.0;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        if (areas[t] == 0.0) continue;
        const Triangle& v = mesh.triangles[t];
        surface += areas[t];
        uv_area += 0.5 * std::abs(uv_cross({mesh.uv1[v[0]], mesh.uv1[v[1]], mesh.uv1[v[2]]}));
    }
    return uv_area > 0.0 ? std::sqrt(surface / uv_area) : 1.0;
}

MeshCharts uv1_islands(const Mesh& mesh, const std::vector<double>& areas, float scale) {
    UnionFind islands(areas.size());  // triangles with the same corner
    std::vector<Corner> corners;
    for (std::uint32_t t = 0; t < areas.size(); ++t) {
        if (areas[t] == 0.0) continue;
        for (const std::uint32_t v : mesh.triangles[t]) corners.push_back({mesh.uv1[v], mesh.positions[v], t});
    }
    std::sort(corners.begin(), corners.end());
    for (std::size_t i = 1; i < corners.size(); ++i)
        if (corners[i].key() == corners[i - 1].key()) islands.unite(corners[i].triangle, corners[i - 1].triangle);

    MeshCharts charts;
    charts.from_uv1 = true;
    charts.chart_of_triangle.assign(areas.size(), kNone);
    charts.uv.assign(areas.size(), {});
    std::vector<std::uint32_t> number(areas.size(), kNone);
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < areas.size(); ++t) {
        if (areas[t] == 0.0) continue;
        std::uint32_t& n = number[islands.find(t)];
        if (n == kNone) n = count++;
        charts.chart_of_triangle[t] = n;
        for (std::size_t k = 0; k < 3; ++k) charts.uv[t][k] = mesh.uv1[mesh.triangles[t][k]] * scale;
    }
    index_charts(charts);
    return charts;
}

}  // namespace lumel
