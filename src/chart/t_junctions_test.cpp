#include "chart/t_junctions.h"

#include <gtest/gtest.h>

#include "chart/parameterize.h"
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
