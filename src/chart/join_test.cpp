#include "chart/join.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "chart/parameterize.h"
#include "chart/segment.h"
#include "support/meshes.h"

namespace lumel {
namespace {

constexpr auto kNever = [] { return false; };

std::vector<FlatChart> unjoined(const Mesh& mesh, const MeshTopology& topology) {
    std::vector<FlatChart> charts;
    for (const auto& cluster : segment(mesh, topology, {}, kNever))
        for (FlatChart& chart : parameterize(mesh, topology, cluster, {}, kNever).charts)
            charts.push_back(std::move(chart));
    return charts;
}

std::vector<FlatChart> joined(const Mesh& mesh, const JoinOptions& options = {}, bool backwards = false) {
    const MeshTopology topology = build_topology(mesh);
    ChartJoiner joiner(mesh, topology, unjoined(mesh, topology), options);
    for (std::size_t c = 0; c < joiner.component_count(); ++c)
        joiner.run(backwards ? joiner.component_count() - 1 - c : c, kNever);
    return joiner.take();
}

// Every triangle with area once; no flips, no overlaps; no more stretch than is allowed.
void expect_valid(const Mesh& mesh, const std::vector<FlatChart>& charts) {
    const MeshTopology topology = build_topology(mesh);
    std::vector<int> seen(mesh.triangles.size(), 0);
    for (const FlatChart& chart : charts) {
        EXPECT_TRUE(is_injective(chart.uv));
        EXPECT_LE(l2_stretch(mesh, chart.triangles, chart.uv), JoinOptions{}.max_stretch);
        for (const std::uint32_t t : chart.triangles) ++seen[t];
    }
    for (std::size_t t = 0; t < seen.size(); ++t) EXPECT_EQ(seen[t], topology.area[t] > 0.0 ? 1 : 0) << t;
}

// A tube, open at both ends, unrolls as one chart that stays cut along one line from end to end.
// However thin it is: unrolled, the two sides of that line are as near as the tube is around.
TEST(Join, ATubeIsCutOnce) {
    for (const float radius : {0.5f, 0.05f, 0.01f}) {
        const Mesh mesh = test::cylinder(48, 1.0f, radius, 3.0f);
        const std::vector<FlatChart> charts = joined(mesh);
        expect_valid(mesh, charts);
        ASSERT_EQ(charts.size(), 1u) << radius;
        EXPECT_LT(l2_stretch(mesh, charts[0].triangles, charts[0].uv), 1.0001);
        double cut = 0.0;
        for (const std::uint32_t e : charts[0].cuts) cut += 0.5 * edge_length(mesh, e);  // both sides are listed
        EXPECT_NEAR(cut, 3.0, 1e-4);
    }
}

// Half a sphere has an L2 stretch of 1.022 (arap_test.cpp), a whole one has no map: two charts at least, and no more
// than the few that greedy pairs leave.
TEST(Join, ASphereIsTwoOrThreeCharts) {
    const Mesh mesh = test::sphere(20, 1.0f);
    const MeshTopology topology = build_topology(mesh);
    const std::vector<FlatChart> charts = joined(mesh);
    expect_valid(mesh, charts);
    EXPECT_GE(charts.size(), 2u);
    EXPECT_LE(charts.size(), 3u);
    EXPECT_GT(unjoined(mesh, topology).size(), charts.size());
}

TEST(Join, CreasesStayCut) {
    const Mesh mesh = test::box({1, 2, 3});
    EXPECT_EQ(joined(mesh).size(), 6u);
}

TEST(Join, WithoutWorkNothingIsTriedButTheLeast) {
    const Mesh mesh = test::sphere(40, 1.0f);  // 6,240 triangles: more than are free
    JoinOptions none;
    none.work = 0.0;
    const std::vector<FlatChart> charts = joined(mesh, none);
    expect_valid(mesh, charts);
    EXPECT_GT(charts.size(), joined(mesh).size());
}

// Components share nothing, so that threads may take them in any order.
TEST(Join, TheOrderOfComponentsGivesTheSameBits) {
    Mesh mesh = test::sphere(16, 1.0f);
    const Mesh tube = test::cylinder(24, 1.0f, 0.5f, 3.0f);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : tube.positions) mesh.positions.push_back(p + Vec3{5, 0, 0});
    mesh.normals.insert(mesh.normals.end(), tube.normals.begin(), tube.normals.end());
    for (const Triangle& t : tube.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    const std::vector<FlatChart> a = joined(mesh), b = joined(mesh, {}, true);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GE(a.size(), 3u);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].triangles, b[i].triangles);
        for (std::size_t t = 0; t < a[i].uv.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(a[i].uv[t][k] == b[i].uv[t][k]);
    }
}

}  // namespace
}  // namespace lumel
