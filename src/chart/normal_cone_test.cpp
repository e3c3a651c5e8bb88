#include "chart/normal_cone.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/statistics.h"

namespace lumel {
namespace {

NormalCone cone(const Eigen::Vector3d& axis, double half_angle) {
    return {axis.normalized(), std::cos(half_angle), std::sin(half_angle)};
}

double half_angle(const NormalCone& c) { return std::atan2(c.sine, c.cosine); }

// On paper: axes 40 degrees apart, half angles 10 and 20: the union spans 10 + 40 + 20 = 70, half of it is 35, and its
// axis lies 25 degrees from the first.
TEST(NormalCone, UnionOfTwoByHand) {
    constexpr double kDegree = 3.14159265358979323846 / 180.0;
    const NormalCone a = cone({1, 0, 0}, 10 * kDegree);
    const NormalCone b = cone({std::cos(40 * kDegree), std::sin(40 * kDegree), 0}, 20 * kDegree);
    const auto u = cone_union(a, b);
    ASSERT_TRUE(u);
    EXPECT_NEAR(half_angle(*u) / kDegree, 35.0, 1e-9);
    EXPECT_NEAR(std::atan2(u->axis.y(), u->axis.x()) / kDegree, 25.0, 1e-9);
}

TEST(NormalCone, OneInsideTheOther) {
    const NormalCone large = cone({0, 0, 1}, 0.8), small = cone({0.1, 0, 1}, 0.2);
    for (const auto& u : {cone_union(large, small), cone_union(small, large)}) {
        ASSERT_TRUE(u);
        EXPECT_DOUBLE_EQ(u->cosine, large.cosine);
    }
}

TEST(NormalCone, MoreThanAHemisphereIsRefused) {
    EXPECT_FALSE(cone_union(cone({1, 0, 0}, 1.0), cone({-1, 0.01, 0}, 0.9)));
    EXPECT_FALSE(cone_union(cone({1, 0, 0}, 0.0), cone({-1, 0, 0}, 0.0)));
}

// Random pairs: the union holds both cones and is no larger than half their common span.
TEST(NormalCone, HoldsBoth) {
    test::Random random(7);
    int unions = 0;
    for (int i = 0; i < 10000; ++i) {
        const auto axis = [&] {
            return Eigen::Vector3d(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
        };
        const NormalCone a = cone(axis(), 0.7 * random.unit()), b = cone(axis(), 0.7 * random.unit());
        const auto u = cone_union(a, b);
        const double between = std::acos(std::clamp(a.axis.dot(b.axis), -1.0, 1.0));
        const double span = std::max({half_angle(a), half_angle(b), 0.5 * (half_angle(a) + between + half_angle(b))});
        ASSERT_EQ(u.has_value(), span < 3.14159265358979323846 / 2) << span;
        if (!u) continue;
        ++unions;
        EXPECT_NEAR(half_angle(*u), span, 1e-7);
        for (const NormalCone& c : {a, b})
            EXPECT_LE(std::acos(std::clamp(u->axis.dot(c.axis), -1.0, 1.0)) + half_angle(c), half_angle(*u) + 1e-6);
    }
    EXPECT_GT(unions, 1000);
}

}  // namespace
}  // namespace lumel
