#include "chart/uv1.h"

#include <gtest/gtest.h>

#include "chart/topology.h"
#include "support/meshes.h"

namespace lumel {
namespace {

// Two quads of 1 x 1 m side by side, apart in space; UVs of each: its own rectangle.
Mesh two_quads(Vec2 low_a, Vec2 size_a, Vec2 low_b, Vec2 size_b) {
    Mesh mesh;
    const auto add = [&](float x, Vec2 low, Vec2 size) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec2 c : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) {
            mesh.positions.push_back({x + c.x, c.y, 0});
            mesh.uv1.push_back(low + c * size);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    };
    add(0, low_a, size_a);
    add(5, low_b, size_b);
    test::add_face_normals(mesh);
    test::cover_with_one_primitive(mesh);
    return mesh;
}

std::vector<double> areas(const Mesh& mesh) { return build_topology(mesh).area; }

TEST(Uv1, AProperLayoutIsFit) {
    const Mesh mesh = two_quads({0, 0}, {0.4f, 0.4f}, {0.5f, 0.5f}, {0.5f, 0.5f});
    EXPECT_EQ(judge_uv1(mesh, areas(mesh)).reason, "");
}

TEST(Uv1, LayoutsThatTouchOrNearlyDoAreFit) {
    // The second rectangle reaches 1/32768 of the page into the first: the rounding of 16-bit coordinates.
    const Mesh mesh = two_quads({0, 0}, {0.5f, 1}, {0.5f - 0x1p-15f, 0}, {0.5f, 1});
    EXPECT_EQ(judge_uv1(mesh, areas(mesh)).reason, "");
}

TEST(Uv1, OverlapsAreListed) {
    const Mesh mesh = two_quads({0, 0}, {0.5f, 0.5f}, {0.25f, 0.25f}, {0.5f, 0.5f});
    const Uv1Verdict verdict = judge_uv1(mesh, areas(mesh));
    EXPECT_FALSE(verdict.fit());
    // Both halves of the first, cut at the diagonal through (1/4, 1/4), meet both halves of the second but for the pair
    // that only shares the diagonal on each side.
    ASSERT_EQ(verdict.overlaps.size(), 2u);
    EXPECT_EQ(verdict.overlaps[0], (std::array<std::uint32_t, 2>{0, 2}));
    EXPECT_EQ(verdict.overlaps[1], (std::array<std::uint32_t, 2>{1, 3}));
}

TEST(Uv1, WhatIsNotALayoutIsRejected) {
    Mesh mesh = two_quads({0, 0}, {0.4f, 0.4f}, {0.5f, 0.5f}, {0.5f, 0.5f});
    mesh.uv1[2].x = 1.01f;
    EXPECT_NE(judge_uv1(mesh, areas(mesh)).reason.find("leaves [0, 1] at triangle 0"), std::string::npos);
    mesh.uv1[2].x = std::nanf("");
    EXPECT_NE(judge_uv1(mesh, areas(mesh)).reason.find("not finite"), std::string::npos);
    const Mesh collapsed = two_quads({0, 0}, {0.4f, 0.4f}, {0.5f, 0.5f}, {0.0f, 0.5f});
    EXPECT_EQ(judge_uv1(collapsed, areas(collapsed)).reason, "50 % of the surface has no area in it");
    mesh.uv1.clear();
    EXPECT_FALSE(judge_uv1(mesh, areas(mesh)).fit());
}

TEST(Uv1, IslandsAreChartsInMetres) {
    const Mesh mesh = two_quads({0, 0}, {0.5f, 0.5f}, {0.5f + 0x1p-6f, 0}, {0.25f, 0.25f});
    const double scale = uv1_scale(mesh, areas(mesh));
    EXPECT_NEAR(scale, std::sqrt(2.0 / (0.25 + 0.0625)), 1e-6);
    const MeshCharts charts = uv1_islands(mesh, areas(mesh), static_cast<float>(scale));
    ASSERT_EQ(charts.charts.size(), 2u);
    EXPECT_TRUE(charts.from_uv1);
    EXPECT_EQ(charts.chart_of_triangle, (std::vector<std::uint32_t>{0, 0, 1, 1}));
    EXPECT_NEAR(charts.charts[0].max.x - charts.charts[0].min.x, 0.5 * scale, 1e-6);
    EXPECT_NEAR(charts.charts[1].max.y - charts.charts[1].min.y, 0.25 * scale, 1e-6);
}

// One corner in the layout but 5 m apart: light of the one must not show on the other.
TEST(Uv1, IslandsThatTouchOnlyInTheLayoutAreTwo) {
    const Mesh mesh = two_quads({0, 0}, {0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f});
    EXPECT_EQ(uv1_islands(mesh, areas(mesh), 1.0f).charts.size(), 2u);
}

TEST(Uv1, IslandsThatAlsoTouchInSpaceAreOne) {
    Mesh mesh = two_quads({0, 0}, {0.5f, 0.5f}, {0.5f, 0}, {0.5f, 0.5f});
    for (std::size_t v = 4; v < 8; ++v) mesh.positions[v].x -= 4;  // vertices of its own at the common edge
    EXPECT_EQ(uv1_islands(mesh, areas(mesh), 1.0f).charts.size(), 1u);
}

}  // namespace
}  // namespace lumel
