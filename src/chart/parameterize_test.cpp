#include "chart/parameterize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "chart/segment.h"
#include "support/meshes.h"

namespace lumel {
namespace {

Parameterized flatten_all(const Mesh& mesh) {
    const MeshTopology topology = build_topology(mesh);
    std::vector<std::uint32_t> all;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (topology.area[t] > 0.0) all.push_back(t);
    return parameterize(mesh, topology, all, {}, [] { return false; });
}

// All triangles, each once, and what every chart owes.
void expect_valid(const Mesh& mesh, const Parameterized& result) {
    const MeshTopology topology = build_topology(mesh);
    std::vector<int> seen(mesh.triangles.size(), 0);
    for (const FlatChart& chart : result.charts) {
        EXPECT_TRUE(is_injective(chart.uv));
        double area = 0.0, image = 0.0;
        for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
            ++seen[chart.triangles[i]];
            area += topology.area[chart.triangles[i]];
            image += 0.5 * uv_cross(chart.uv[i]);
        }
        EXPECT_NEAR(image / area, 1.0, 1e-4) << "metres, up to the rounding of float UVs";
    }
    for (std::size_t t = 0; t < seen.size(); ++t) EXPECT_EQ(seen[t], topology.area[t] > 0.0 ? 1 : 0) << t;
}

// A plane in space, far from its axes: edges keep their lengths to the rounding of float coordinates.
TEST(Parameterize, PlanesAreIsometric) {
    const Vec3 u = normalize({1, 2, 0.5f}), v = normalize(cross(u, {0.3f, -1, 2}));
    const Mesh mesh = test::surface(7, 5, [&](float s, float t) {
        return Vec3{10, -3, 4} + u * (3.0f * s + 0.3f * t) + v * (2.0f * t);
    });
    const Parameterized result = flatten_all(mesh);
    expect_valid(mesh, result);
    ASSERT_EQ(result.charts.size(), 1u);
    const FlatChart& chart = result.charts[0];
    for (std::size_t i = 0; i < chart.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle& t = mesh.triangles[chart.triangles[i]];
            const float in_space = length(mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]);
            EXPECT_NEAR(length(chart.uv[i][k] - chart.uv[i][(k + 1) % 3]), in_space, 5e-6f);  // 10 m: ulp 1e-6
        }
}

// A third of a tube unrolls without stretch, whatever its facets; a sphere's cap cannot, but comes near.
TEST(Parameterize, DevelopableSurfacesUnroll) {
    const Mesh mesh = test::cylinder(24, 0.36f, 1.0f, 2.0f);
    const Parameterized result = flatten_all(mesh);
    expect_valid(mesh, result);
    ASSERT_EQ(result.charts.size(), 1u);
    EXPECT_NEAR(l2_stretch(mesh, result.charts[0].triangles, result.charts[0].uv), 1.0, 1e-6);
}

// A cap of half angle a has on its conformal image the scale 1 / cos^2(r / 2) at angle r, at best: for 60 degrees
// between 1 and 4/3. The L2 stretch of that map, scaled to equal areas, is sqrt(mean(s^-2) mean(s^2)); with c = cos r,
// uniform in [1/2, 1] over the cap, s = 2 / (1 + c): mean s^2 = 4/3, mean s^-2 = 0.7708, L2 = 1.0138.
TEST(Parameterize, ACapComesOutConformal) {
    const Mesh mesh = test::surface(96, 24, [](float u, float v) {
        const float phi = 6.2831853f * u, r = 1.0471976f * (1.0f - v);
        return Vec3{std::sin(r) * std::cos(phi), std::sin(r) * std::sin(phi), std::cos(r)};
    });
    const Parameterized result = flatten_all(mesh);
    expect_valid(mesh, result);
    ASSERT_EQ(result.charts.size(), 1u);
    // LSCM's free border does no worse than the stereographic map; facets of 4 degrees change the figure by 0.1 %.
    EXPECT_LE(l2_stretch(mesh, result.charts[0].triangles, result.charts[0].uv), 1.015);
}

// Two and a half turns of a spiral ramp lie on top of each other in any map of the whole.
TEST(Parameterize, SplitsWhatWouldOverlap) {
    const Mesh mesh = test::surface(120, 3, [](float u, float v) {
        const float angle = 15.707963f * u, r = 1.0f + v;
        return Vec3{r * std::cos(angle), r * std::sin(angle), 0.5f * u};
    });
    const Parameterized result = flatten_all(mesh);
    expect_valid(mesh, result);
    EXPECT_GE(result.charts.size(), 3u);
    EXPECT_LE(result.charts.size(), 12u);
    EXPECT_EQ(result.fallbacks, 0u);
}

// A flat grid with one corner of its middle pushed over the opposite side: a few triangles have to go, not half the
// chart.
TEST(Parameterize, PeelsOffWhatIsWrong) {
    Mesh mesh = test::flat_grid(20, 20.0f);
    mesh.positions[10 * 21 + 10] = mesh.positions[10 * 21 + 12] + Vec3{0.1f, 0.05f, 0.4f};
    const Parameterized result = flatten_all(mesh);
    expect_valid(mesh, result);
    EXPECT_LE(result.charts.size(), 4u);
    std::size_t largest = 0;
    for (const FlatChart& chart : result.charts) largest = std::max(largest, chart.triangles.size());
    EXPECT_GE(largest, 790u) << "of 800";
}

// A whole sphere is hopeless as one chart; it must still come out, in pieces.
TEST(Parameterize, SurvivesAClosedSurface) {
    const Mesh mesh = test::sphere(12, 1.0f);
    const Parameterized result = flatten_all(mesh);
    expect_valid(mesh, result);
    EXPECT_GE(result.charts.size(), 2u);
    EXPECT_LE(result.charts.size(), 40u);
}

TEST(Parameterize, SliversBesideLargeTriangles) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {30, 0, 0}, {15, -20, 0}, {15, 1e-4f, 0}, {15, 20, 0}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 4}, {3, 1, 4}};
    test::add_face_normals(mesh);
    expect_valid(mesh, flatten_all(mesh));
}

// Where no map fits because splitting is forbidden, the box takes over.
TEST(Parameterize, FallsBackToTheBox) {
    const Mesh mesh = test::sphere(12, 1.0f);
    const MeshTopology topology = build_topology(mesh);
    std::vector<std::uint32_t> all;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (topology.area[t] > 0.0) all.push_back(t);
    ParameterizeOptions options;
    options.max_splits = 0;
    const Parameterized result = parameterize(mesh, topology, all, options, [] { return false; });
    expect_valid(mesh, result);
    EXPECT_EQ(result.fallbacks, 1u);
    EXPECT_EQ(result.charts.size(), 6u);
}

TEST(Parameterize, InjectivityNotices) {
    const UvTriangle a{{{0, 0}, {1, 0}, {0, 1}}}, inside{{{0.1f, 0.1f}, {0.3f, 0.1f}, {0.1f, 0.3f}}};
    const UvTriangle flipped{{{1, 0}, {0, 1}, {1, 1}}}, beside{{{1, 0}, {1, 1}, {0, 1}}};
    EXPECT_TRUE(is_injective({a, beside}));
    EXPECT_FALSE(is_injective({a, inside}));
    EXPECT_FALSE(is_injective({a, flipped}));
}

// On paper: a unit square drawn twice as wide as high, with equal area: singular values of the inverse map are
// 1/sqrt 2 and sqrt 2, L2 = sqrt((1/2 + 2) / 2).
TEST(Parameterize, StretchByHand) {
    const Mesh mesh = test::flat_grid(1, 1.0f);
    const float w = 1.41421356f, h = 0.70710678f;
    const std::vector<UvTriangle> uv{{{{0, 0}, {w, 0}, {w, h}}}, {{{0, 0}, {w, h}, {0, h}}}};
    EXPECT_NEAR(l2_stretch(mesh, {0, 1}, uv), std::sqrt(1.25), 1e-6);
    std::vector<UvTriangle> larger = uv;
    for (UvTriangle& t : larger)
        for (Vec2& p : t) p = p * 7.0f;
    EXPECT_NEAR(l2_stretch(mesh, {0, 1}, larger), std::sqrt(1.25), 1e-6) << "size does not count";
}

}  // namespace
}  // namespace lumel
