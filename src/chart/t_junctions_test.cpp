#include "chart/t_junctions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "chart/parameterize.h"
#include "chart/patch.h"
#include "chart/segment.h"
#include "support/meshes.h"

namespace lumel {
namespace {

// A quad with vertices of its own, two triangles.
void add_quad(Mesh& mesh, Vec3 corner, Vec3 u, Vec3 v) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : {corner, corner + u, corner + u + v, corner + v}) mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

// A wall of one tall panel beside three of unequal height that fill the same side.
Mesh panelled_wall() {
    Mesh mesh;
    add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {0, 3, 0});
    add_quad(mesh, {2, 0, 0}, {1, 0, 0}, {0, 0.5f, 0});
    add_quad(mesh, {2, 0.5f, 0}, {1, 0, 0}, {0, 1.25f, 0});
    add_quad(mesh, {2, 1.75f, 0}, {1, 0, 0}, {0, 1.25f, 0});
    test::add_face_normals(mesh);
    return mesh;
}

std::vector<FlatChart> charts_of(const Mesh& mesh) {
    const MeshTopology topology = build_topology(mesh);
    const auto never = [] { return false; };
    std::vector<FlatChart> charts;
    for (const auto& cluster : unite_across_t_junctions(mesh, topology, segment(mesh, topology, {}, never)))
        for (FlatChart& chart : parameterize(mesh, topology, cluster, {}, never).charts)
            charts.push_back(std::move(chart));
    return charts;
}

TEST(TJunctions, HaveTheLengthsOfThePieces) {
    const Mesh mesh = panelled_wall();
    const std::vector<SmoothContact> contacts = t_junctions(mesh, build_topology(mesh));
    ASSERT_EQ(contacts.size(), 3u);
    double total = 0.0;
    for (const SmoothContact& c : contacts) {
        total += c.length;
        const auto at = [&](std::uint32_t edge, double s) {
            const Vec3 a = mesh.positions[corner_vertex(mesh, edge)],
                       b = mesh.positions[corner_vertex(mesh, next_edge(edge))];
            return a + (b - a) * static_cast<float>(s);
        };
        EXPECT_LT(length(at(c.a, c.a_from) - at(c.b, c.b_from)), 1e-6f);
        EXPECT_LT(length(at(c.a, c.a_to) - at(c.b, c.b_to)), 1e-6f);
        EXPECT_NEAR(length(at(c.a, c.a_from) - at(c.a, c.a_to)), c.length, 1e-6);
    }
    EXPECT_NEAR(total, 3.0, 1e-6);
}

TEST(TJunctions, AWallOfPanelsIsOneChart) {
    const std::vector<FlatChart> charts = charts_of(panelled_wall());
    ASSERT_EQ(charts.size(), 1u);
    EXPECT_EQ(charts[0].triangles.size(), 8u);
    EXPECT_TRUE(is_injective(charts[0].uv));
}

TEST(TJunctions, WhatIsBentOrBesideIsNone) {
    Mesh bent;
    add_quad(bent, {0, 0, 0}, {2, 0, 0}, {0, 3, 0});
    add_quad(bent, {2, 0, 0}, {1, 0, 0.2f}, {0, 1, 0});
    add_quad(bent, {-1, 0, 0.01f}, {1, 0, 0}, {0, 1, 0});
    test::add_face_normals(bent);
    EXPECT_TRUE(t_junctions(bent, build_topology(bent)).empty());
}

// A wall of bricks in running bond, `gap` apart, turned about z; bricks of 1 x 0.5 m.
Mesh brick_wall(int rows, int columns, double gap, double angle) {
    Mesh mesh;
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](double x, double y) {
        return Vec3{static_cast<float>(c * x - s * y), static_cast<float>(s * x + c * y), 0.0f};
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const Vec3 corner = turned(column * (1.0 + gap) + (row % 2) * 0.5, row * (0.5 + gap));
            add_quad(mesh, corner, turned(1.0, 0.0), turned(0.0, 0.5));
        }
    test::add_face_normals(mesh);
    return mesh;
}

// Gaps within a ten-thousandth of the shorter edge (5e-5 m) are none, whichever way the wall is turned.
TEST(TJunctions, ABrickWallWithTinyGapsIsOneChart) {
    for (const double angle : {0.0, 0.5}) {
        const std::vector<FlatChart> charts = charts_of(brick_wall(16, 16, 2e-5, angle));
        EXPECT_EQ(charts.size(), 1u) << angle;
        EXPECT_EQ(charts_of(brick_wall(4, 4, 1e-3, angle)).size(), 16u) << "gaps that are some";
    }
}

// A ring of 1000 panels, every other one half a metre higher, each turned by 0.36 degrees: any two are in one plane,
// all of them are not. What is united stays flat, and is as much as two degrees to either side allow: some ten panels.
TEST(TJunctions, ABendOfManySmallStepsIsNotOnePlane) {
    constexpr int kPanels = 1000;
    Mesh mesh;
    const auto at = [](int k) {
        const double angle = 2.0 * 3.14159265358979 * k / kPanels;
        return Vec3{static_cast<float>(100.0 * std::cos(angle)), static_cast<float>(100.0 * std::sin(angle)), 0.0f};
    };
    for (int k = 0; k < kPanels; ++k)
        add_quad(mesh, at(k) + Vec3{0, 0, 0.5f * static_cast<float>(k % 2)}, at(k + 1) - at(k), {0, 0, 3});
    test::add_face_normals(mesh);
    const MeshTopology topology = build_topology(mesh);
    std::vector<std::vector<std::uint32_t>> clusters;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 2) clusters.push_back({t, t + 1});
    const auto united = unite_across_t_junctions(mesh, topology, clusters);
    EXPECT_LE(united.size(), kPanels / 5u);
    for (const auto& cluster : united)
        EXPECT_TRUE(is_planar(topology, cluster, mean_normal(topology, cluster), 0.9994)) << cluster.size();
}

// The box of a long edge is full of edges that it does not come near: here those of 10,000 panels. It finds its
// neighbour all the same.
TEST(TJunctions, ALongDiagonalFindsWhatItTouches) {
    Mesh mesh;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x)
            add_quad(mesh, {0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y), 5.0f}, {0.09f, 0, 0},
                     {0, 0.09f, 0});
    // Two triangles of a slanting plane that touch along the diagonal of a cube, the second on 8 of its 10 metres.
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p :
         {Vec3{0, 0, 0}, Vec3{10, 0, 0}, Vec3{10, 10, 10}, Vec3{9, 9, 9}, Vec3{0, 10, 10}, Vec3{1, 1, 1}})
        mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first + 3, first + 4, first + 5});
    test::add_face_normals(mesh);
    const std::vector<SmoothContact> contacts = t_junctions(mesh, build_topology(mesh));
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].length, 8.0 * std::sqrt(3.0), 1e-5);
}

// Two panels on the same place beside a third: they touch it both, and only one of them fits.
TEST(TJunctions, WhatWouldOverlapStaysApart) {
    Mesh mesh;
    add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {0, 3, 0});
    add_quad(mesh, {2, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_quad(mesh, {2, 0.5f, 0}, {1, 0, 0}, {0, 1, 0});
    test::add_face_normals(mesh);
    const std::vector<FlatChart> charts = charts_of(mesh);
    EXPECT_GE(charts.size(), 2u);
    std::size_t triangles = 0;
    for (const FlatChart& chart : charts) {
        EXPECT_TRUE(is_injective(chart.uv));
        triangles += chart.triangles.size();
    }
    EXPECT_EQ(triangles, mesh.triangles.size());
}

}  // namespace
}  // namespace lumel
