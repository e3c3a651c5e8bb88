#include "chart/crease.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.h"

namespace lumel {
namespace {

// A box is smooth along the diagonals of its six sides only.
TEST(Crease, ABoxIsSmoothWithinItsSides) {
    const Mesh mesh = test::box({1, 2, 3});
    const std::vector<SmoothContact> contacts = smooth_contacts(mesh, build_topology(mesh), {});
    ASSERT_EQ(contacts.size(), 6u);
    double total = 0.0;
    for (const SmoothContact& c : contacts) total += c.length;
    EXPECT_NEAR(total, 2.0 * (std::sqrt(5.0) + std::sqrt(10.0) + std::sqrt(13.0)), 1e-5);
}

// Both sides of an edge see the same.
TEST(Crease, IsTheSameFromBothSides) {
    const Mesh mesh = test::sphere(6, 1.0f);
    const MeshTopology topology = build_topology(mesh);
    std::size_t inner = 0;
    for (std::uint32_t e = 0; e < topology.twin.size(); ++e) {
        if (topology.twin[e] == kNone) continue;
        ++inner;
        EXPECT_EQ(is_crease(mesh, topology, {}, e), is_crease(mesh, topology, {}, topology.twin[e]));
    }
    EXPECT_GT(inner, 0u);
}

}  // namespace
}  // namespace lumel
