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

// Within a cone of half angle 70 degrees no two normals are more than 140 degrees apart.
TEST(Segment, ClustersStayWithinTheirCone) {
    for (const Mesh& mesh : {test::sphere(24, 1.0f), test::cylinder(90, 1.0f, 1.0f, 3.0f)}) {
        const MeshTopology topology = build_topology(mesh);
        float widest = 1.0f;
        for (const auto& cluster : segment(mesh, topology, {}, [] { return false; }))
            for (const std::uint32_t a : cluster)
                for (const std::uint32_t b : cluster)
                    widest = std::min(widest, dot(topology.normal[a], topology.normal[b]));
        EXPECT_GE(widest, -0.7661f);
        EXPECT_LT(widest, 0.0f) << "and the cone is made use of";
    }
}

}  // namespace
}  // namespace lumel
