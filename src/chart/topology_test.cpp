#include "chart/topology.h"

#include <gtest/gtest.h>

#include "support/meshes.h"

namespace lumel {
namespace {

std::size_t inner_edges(const MeshTopology& topology) {
    std::size_t count = 0;
    for (std::uint32_t e = 0; e < topology.twin.size(); ++e) {
        if (topology.twin[e] == kNone) continue;
        EXPECT_EQ(topology.twin[topology.twin[e]], e);
        ++count;
    }
    return count / 2;
}

// A closed box of 12 triangles has 18 edges, though its file splits every corner three times.
TEST(Topology, WeldsSplitVertices) {
    const MeshTopology topology = build_topology(test::box({1, 2, 3}));
    EXPECT_EQ(inner_edges(topology), 18u);
    EXPECT_NEAR(topology.area[0] + topology.area[1], 2.0, 1e-12);
}

// 4 x 4 quads: 32 triangles have 96 sides, 16 of them on the border.
TEST(Topology, FindsBorders) { EXPECT_EQ(inner_edges(build_topology(test::flat_grid(4, 1.0f))), (96u - 16u) / 2u); }

// A sheet whose file has its own back faces on the same points: four triangles around each inner edge.
TEST(Topology, KeepsTheLayersOfADoubleSheetApart) {
    Mesh mesh = test::flat_grid(3, 1.0f);
    const auto front = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t t = 0; t < front; ++t)
        mesh.triangles.push_back({mesh.triangles[t][0], mesh.triangles[t][2], mesh.triangles[t][1]});
    const MeshTopology topology = build_topology(mesh);
    std::size_t within = 0;
    for (std::uint32_t e = 0; e < 3 * front; ++e) {
        if (topology.twin[e] == kNone || topology.twin[e] >= 3 * front) continue;
        ++within;
    }
    EXPECT_EQ(within, 2u * 21u) << "3 x 3 quads have 21 inner edges";
}

TEST(Topology, EdgesOfManyTrianglesPairUpOrEnd) {
    // Five half planes around the z axis: at most two pairs can continue each other.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}};
    for (int k = 0; k < 5; ++k) {
        const float angle = 1.2566371f * static_cast<float>(k);
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.5f});
        const auto v = static_cast<std::uint32_t>(mesh.positions.size() - 1);
        mesh.triangles.push_back(k % 2 == 0 ? Triangle{0, 1, v} : Triangle{1, 0, v});
    }
    EXPECT_EQ(inner_edges(build_topology(mesh)), 2u);
}

TEST(Topology, TrianglesWithoutAreaHaveNoNeighbours) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {3, 4, 1}, {0, 0, 1}};
    const MeshTopology topology = build_topology(mesh);
    EXPECT_GT(topology.area[0], 0.0);
    for (int t = 1; t < 4; ++t) EXPECT_EQ(topology.area[static_cast<std::size_t>(t)], 0.0) << t;
    EXPECT_EQ(inner_edges(topology), 0u);
}

TEST(Topology, MinusZeroIsZero) {
    Mesh mesh;
    mesh.positions = {{0.0f, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, 0}, {1, 0, -0.0f}, {0, -1, 0}};
    mesh.triangles = {{0, 1, 2}, {4, 3, 5}};
    EXPECT_EQ(inner_edges(build_topology(mesh)), 1u);
}

}  // namespace
}  // namespace lumel
