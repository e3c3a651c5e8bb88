// An independent judge of a lightmap layout: sees only the UVs that Atlas::triangle_uv gives, and finds with plain
// formulas of its own what the layout must never have.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "chart/chart_set.h"
#include "scene/world_geometry.h"

namespace lumel::test {

struct LayoutReport {
    std::uint64_t shared_texels = 0;  // that a bilinear lookup of two charts can touch
    std::uint64_t outside = 0;        // texels touched beyond the page
    std::uint64_t unmapped = 0;       // triangles of lightmap instances with area in mesh space but no texels
    std::uint64_t flipped = 0;        // triangles of our own charts that are not counter-clockwise
    std::uint64_t overlaps = 0;       // sample points of charts inside two triangles
    std::uint64_t samples = 0;        // such points inside some triangle: 0 means nothing was tested
    std::uint64_t texels = 0;         // of all masks
    std::uint64_t page_texels = 0;
    double stretch = 0.0, worst_stretch = 0.0;  // Sander's L2 over our own charts: mean by area; the worst chart
};

namespace detail {

struct Point {
    double x, y;
};
using Corners = std::array<Point, 3>;

inline double turn(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Do the triangle and the open square of half side h around c share a point? Separating axes: x, y, the edges' normals.
inline bool meets_square(const Corners& t, Point c, double h) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    if (x0 >= c.x + h || x1 <= c.x - h || y0 >= c.y + h || y1 <= c.y - h) return false;
    for (int k = 0; k < 3; ++k) {
        const Point a = t[k], b = t[(k + 1) % 3], o = t[(k + 2) % 3];
        const double nx = a.y - b.y, ny = b.x - a.x;
        const double centre = nx * (c.x - a.x) + ny * (c.y - a.y), reach = h * (std::abs(nx) + std::abs(ny));
        const double other = nx * (o.x - a.x) + ny * (o.y - a.y);
        if (centre - reach >= std::max(0.0, other) || centre + reach <= std::min(0.0, other)) return false;
    }
    return true;
}

inline double mesh_area(const Mesh& mesh, std::uint32_t t) {
    const auto p = [&](int k) { return mesh.positions[mesh.triangles[t][k]]; };
    double n[3], e1[3], e2[3];
    for (std::size_t c = 0; c < 3; ++c) e1[c] = double{p(1)[c]} - p(0)[c], e2[c] = double{p(2)[c]} - p(0)[c];
    for (std::size_t c = 0; c < 3; ++c) n[c] = e1[(c + 1) % 3] * e2[(c + 2) % 3] - e1[(c + 2) % 3] * e2[(c + 1) % 3];
    const double longest =
        std::max(e1[0] * e1[0] + e1[1] * e1[1] + e1[2] * e1[2], e2[0] * e2[0] + e2[1] * e2[1] + e2[2] * e2[2]);
    const double area = 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return area > 1e-7 * longest ? area : 0.0;  // thinner than float coordinates can tell
}

// Squared L2 stretch of a triangle times its surface area: half the trace of the metric in UV.
inline double stretch_energy(const Mesh& mesh, std::uint32_t t, const std::array<Vec2, 3>& uv) {
    const auto p = [&](int k) { return mesh.positions[mesh.triangles[t][k]]; };
    double g11 = 0, g12 = 0, g22 = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double e1 = double{p(1)[c]} - p(0)[c], e2 = double{p(2)[c]} - p(0)[c];
        g11 += e1 * e1, g12 += e1 * e2, g22 += e2 * e2;
    }
    const double ax = double{uv[1].x} - uv[0].x, ay = double{uv[1].y} - uv[0].y;
    const double bx = double{uv[2].x} - uv[0].x, by = double{uv[2].y} - uv[0].y;
    const double determinant = ax * by - ay * bx;
    const double trace = (g11 * (bx * bx + by * by) - 2.0 * g12 * (ax * bx + ay * by) + g22 * (ax * ax + ay * ay)) /
                         (determinant * determinant);
    return mesh_area(mesh, t) * 0.5 * trace;
}

}  // namespace detail

class ChartChecker {
public:
    ChartChecker(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas)
        : scene_(scene), geometry_(geometry), charts_(charts), atlas_(atlas) {}

    LayoutReport run() {
        check_texels();
        for (std::size_t m = 0; m < charts_.meshes.size(); ++m) check_mesh(*scene_.meshes[m], charts_.meshes[m]);
        report_.stretch = surface_ > 0.0 ? std::sqrt(energy_ / surface_) : 0.0;
        return report_;
    }

private:
    // Placed UVs are floats: at the far end of a page of 4096 texels they lie within 2^-12 of their places, and a
    // chart's own box ends on texel centres. Overlaps of masks that are not wider than this are its rounding.
    static constexpr double kSlack = 0x1p-10;

    void check_texels() {
        std::vector<std::vector<std::uint32_t>> owner;
        for (const AtlasPage& page : atlas_.pages) {
            owner.emplace_back(std::size_t{page.width} * page.height, kNone);
            report_.page_texels += owner.back().size();
        }
        for (std::uint32_t w = 0; w < geometry_.triangle_count(); ++w) {
            const WorldTriangle& triangle = geometry_.triangles[w];
            const Instance& instance = scene_.instances[triangle.instance];
            const Atlas::TriangleUv uv = atlas_.triangle_uv(charts_, geometry_, scene_, w);
            if (uv.page == kNone) {
                report_.unmapped += charts_.gets_texels(scene_, triangle.instance) &&
                                    detail::mesh_area(*scene_.meshes[instance.mesh], triangle.mesh_triangle) > 0.0;
                continue;
            }
            const std::uint32_t chart = charts_.meshes[instance.mesh].chart_of_triangle[triangle.mesh_triangle];
            claim(uv, atlas_.first_placement[triangle.instance] + chart, owner[uv.page]);
        }
    }

    void claim(const Atlas::TriangleUv& uv, std::uint32_t id, std::vector<std::uint32_t>& owner) {
        const AtlasPage& page = atlas_.pages[uv.page];
        detail::Corners t;
        for (std::size_t k = 0; k < 3; ++k) t[k] = {uv.texels[k].x, uv.texels[k].y};
        const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
        for (auto y = static_cast<std::int64_t>(std::floor(y0)) - 1; y <= static_cast<std::int64_t>(y1) + 1; ++y)
            for (auto x = static_cast<std::int64_t>(std::floor(x0)) - 1; x <= static_cast<std::int64_t>(x1) + 1; ++x) {
                if (!detail::meets_square(t, {double(x) + 0.5, double(y) + 0.5}, 1.0 - kSlack)) continue;
                if (x < 0 || y < 0 || x >= page.width || y >= page.height) {
                    ++report_.outside;
                    continue;
                }
                std::uint32_t& o = owner[static_cast<std::size_t>(y) * page.width + static_cast<std::size_t>(x)];
                report_.texels += o == kNone;
                report_.shared_texels += o != kNone && o != id;
                o = id;
            }
    }

    void check_mesh(const Mesh& mesh, const MeshCharts& charts) {
        for (const Chart& chart : charts.charts) {
            count_overlaps(charts, chart);
            if (!charts.from_uv1) measure(mesh, charts, chart);
        }
    }

    // Points of a grid over the chart's box that lie well inside two triangles.
    void count_overlaps(const MeshCharts& charts, const Chart& chart) {
        const double width = double{chart.max.x} - chart.min.x, height = double{chart.max.y} - chart.min.y;
        const double longest = std::max(width, height);
        const double points = std::clamp(8.0 * std::sqrt(double(chart.count)), 8.0, 256.0);
        const double step = longest / points, margin = longest * 0x1p-18;
        if (!(step > 0.0)) return;
        const auto nx = static_cast<std::size_t>(width / step) + 1, ny = static_cast<std::size_t>(height / step) + 1;
        std::vector<std::uint8_t> hit(nx * ny, 0);
        for (std::uint32_t k = chart.first; k < chart.first + chart.count; ++k) {
            detail::Corners t;
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec2 p = charts.uv[charts.order[k]][c];
                t[c] = {double{p.x} - chart.min.x, double{p.y} - chart.min.y};
            }
            if (detail::turn(t[0], t[1], t[2]) < 0.0) std::swap(t[1], t[2]);
            visit_inside(t, step, margin, nx, ny, [&](std::size_t i) {
                report_.samples += hit[i] == 0;
                report_.overlaps += hit[i] != 0;
                hit[i] = 1;
            });
        }
    }

    // Grid points (i + 0.437) * step at least `margin` inside all three edges.
    template <class Visit>
    static void visit_inside(const detail::Corners& t, double step, double margin, std::size_t nx, std::size_t ny,
                             const Visit& visit) {
        const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
        const auto first = [&](double v) { return static_cast<std::size_t>(std::max(0.0, v / step - 1.0)); };
        for (std::size_t j = first(y0); j < ny && double(j) * step <= y1; ++j)
            for (std::size_t i = first(x0); i < nx && double(i) * step <= x1; ++i) {
                const detail::Point p{(double(i) + 0.437) * step, (double(j) + 0.437) * step};
                bool inside = true;
                for (int k = 0; k < 3 && inside; ++k) {
                    const detail::Point a = t[k], b = t[(k + 1) % 3];
                    inside = detail::turn(a, b, p) > margin * std::hypot(b.x - a.x, b.y - a.y);
                }
                if (inside) visit(j * nx + i);
            }
    }

    void measure(const Mesh& mesh, const MeshCharts& charts, const Chart& chart) {
        double energy = 0.0, surface = 0.0, image = 0.0;
        for (std::uint32_t k = chart.first; k < chart.first + chart.count; ++k) {
            const std::uint32_t t = charts.order[k];
            const std::array<Vec2, 3>& uv = charts.uv[t];
            const double turn = detail::turn({uv[0].x, uv[0].y}, {uv[1].x, uv[1].y}, {uv[2].x, uv[2].y});
            const double area = detail::mesh_area(mesh, t);
            if (area == 0.0) continue;
            report_.flipped += turn <= 0.0;
            image += 0.5 * std::abs(turn);
            // The figures of triangles thinner than the grid of float UVs are those of rounding.
            const double longest = std::max({length(uv[1] - uv[0]), length(uv[2] - uv[1]), length(uv[0] - uv[2])});
            const double extent = std::max(chart.max.x, chart.max.y);
            const bool measurable = std::abs(turn) > 0x1p-18 * extent * longest;
            energy += measurable ? detail::stretch_energy(mesh, t, uv) : area;
            surface += area;
        }
        if (surface == 0.0) return;
        energy *= image / surface;
        energy_ += energy, surface_ += surface;
        report_.worst_stretch = std::max(report_.worst_stretch, std::sqrt(energy / surface));
    }

    const Scene& scene_;
    const WorldGeometry& geometry_;
    const ChartSet& charts_;
    const Atlas& atlas_;
    LayoutReport report_;
    double energy_ = 0.0, surface_ = 0.0;
};

}  // namespace lumel::test
