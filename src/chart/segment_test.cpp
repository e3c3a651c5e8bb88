#include "chart/segment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/meshes.h"

namespace lumel {
namespace {

std::vector<std::vector<std::uint32_t>> clusters_of(const Mesh& mesh) {
    return segment(mesh, build_topology(mesh), {}, [] { return false; });
}

std::size_t total(const std::vector<std::vector<std::uint32_t>>& clusters) {
    std::size_t n = 0;
    for (const auto& c : clusters) n += c.size();
    return n;
}

TEST(Segment, ABoxHasSixSides) {
    const auto clusters = clusters_of(test::box({1, 2, 3}));
    ASSERT_EQ(clusters.size(), 6u);
    for (const auto& c : clusters) EXPECT_EQ(c.size(), 2u);
}

TEST(Segment, AFlatGridIsOneCluster) {
    const auto clusters = clusters_of(test::flat_grid(20, 5.0f));
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_EQ(clusters[0].size(), 800u);
    EXPECT_TRUE(std::is_sorted(clusters[0].begin(), clusters[0].end()));
}

// A cone of half angle 70 degrees takes in a third of a sphere: fewer than 4 cannot be, and more than four times that
// would be confetti.
TEST(Segment, ASmoothSphereIsCutIntoFewPieces) {
    for (const std::uint32_t n : {8u, 16u, 64u}) {
        const Mesh mesh = test::sphere(n, 1.0f);
        const auto clusters = clusters_of(mesh);
        EXPECT_GE(clusters.size(), 4u) << n;
        EXPECT_LE(clusters.size(), 16u) << n;
        EXPECT_EQ(total(clusters), 4u * n * (n - 1)) << "all but those collapsed at the poles";
        const auto smallest = std::min_element(clusters.begin(), clusters.end(),
                                               [](const auto& a, const auto& b) { return a.size() < b.size(); });
        EXPECT_GT(smallest->size(), 2u) << n;
    }
}

// 360 degrees by cones of 140.
TEST(Segment, ATubeIsCutLengthwise) {
    const auto clusters = clusters_of(test::cylinder(64, 1.0f, 1.0f, 10.0f));
    EXPECT_GE(clusters.size(), 3u);
    EXPECT_LE(clusters.size(), 6u);
    EXPECT_EQ(total(clusters), 64u * 4 * 2);
}

// Two quads at 45 degrees: one cluster if they share vertex normals, two if the file has each its own.
TEST(Segment, HardEdgesCutSoonerThanSmoothOnes) {
    Mesh smooth = test::surface(2, 1, [](float u, float v) {
        return u <= 0.5f ? Vec3{u, v, 0} : Vec3{0.5f + 0.7071f * (u - 0.5f), v, 0.7071f * (u - 0.5f)};
    });
    EXPECT_EQ(clusters_of(smooth).size(), 1u);

    Mesh hard = smooth;
    hard.positions.clear();
    for (Triangle& t : hard.triangles)
        for (std::uint32_t& v : t) {
            hard.positions.push_back(smooth.positions[v]);
            v = static_cast<std::uint32_t>(hard.positions.size() - 1);
        }
    test::add_face_normals(hard);
    EXPECT_EQ(clusters_of(hard).size(), 2u);
}

TEST(Segment, SharpEdgesCutEvenSmoothShading) {
    const Mesh mesh = test::surface(2, 1, [](float u, float v) {
        return u <= 0.5f ? Vec3{u, v, 0} : Vec3{0.5f, v, u - 0.5f};
    });
    EXPECT_EQ(clusters_of(mesh).size(), 2u);
}

// Every normal lies within the cone around some axis: the cluster's mean normal is within twice the half angle of all.
TEST(Segment, ClustersStayWithinTheirCone) {
    Mesh mesh = test::sphere(32, 1.0f);
    const MeshTopology topology = build_topology(mesh);
    for (const auto& cluster : segment(mesh, topology, {}, [] { return false; })) {
        Vec3 sum{};
        for (const std::uint32_t t : cluster) sum += topology.normal[t] * static_cast<float>(topology.area[t]);
        for (const std::uint32_t t : cluster) EXPECT_GT(dot(normalize(sum), topology.normal[t]), 0.0f);
    }
}

}  // namespace
}  // namespace lumel
