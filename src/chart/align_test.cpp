#include "chart/align.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/statistics.h"

namespace lumel {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points turned(const Points& points, double angle) {
    Points out;
    for (const Eigen::Vector2d& p : points)
        out.emplace_back(std::cos(angle) * p.x() - std::sin(angle) * p.y() + 5.0,
                         std::sin(angle) * p.x() + std::cos(angle) * p.y() - 7.0);
    return out;
}

Eigen::Vector2d size_of(const Points& points) {
    Eigen::Vector2d low = points[0], high = points[0];
    for (const Eigen::Vector2d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    EXPECT_NEAR(low.norm(), 0.0, 1e-9) << "the box starts at (0, 0)";
    return high;
}

TEST(Align, FindsTheRectangleAtAnyAngle) {
    for (int k = 0; k < 12; ++k) {
        Points points = turned({{0, 0}, {2, 0}, {2, 3}, {0, 3}, {1, 1}}, 0.531 * k);
        align_to_box(points);
        const Eigen::Vector2d size = size_of(points);
        EXPECT_NEAR(size.x(), 3.0, 1e-9) << "at least as wide as high";
        EXPECT_NEAR(size.y(), 2.0, 1e-9);
        const Eigen::Vector2d a = points[1] - points[0], b = points[3] - points[0];
        EXPECT_NEAR(a.x() * b.y() - a.y() * b.x(), 6.0, 1e-9) << "not mirrored";
    }
}

// The boxes on all three sides of a triangle have the same area: the longest side wins.
TEST(Align, TrianglesLieOnTheirLongestSide) {
    Points points = turned({{0, 0}, {5, 0}, {1, 2}}, 1.1);
    align_to_box(points);
    EXPECT_NEAR(points[0].y(), points[1].y(), 1e-9);
    EXPECT_NEAR(size_of(points).x(), 5.0, 1e-9);
}

// Random clouds: within 1 % of the smallest box of a search over 1,800 angles.
TEST(Align, TheBoxIsSmall) {
    test::Random random(2);
    for (int n = 0; n < 100; ++n) {
        Points points(6);
        for (Eigen::Vector2d& p : points) p = {3.0 * random.unit(), random.unit()};
        double smallest = 1e9;
        for (int k = 0; k < 1800; ++k) {
            const double c = std::cos(k * 8.7266e-4), s = std::sin(k * 8.7266e-4);
            Eigen::Vector2d low(1e9, 1e9), high = -low;
            for (const Eigen::Vector2d& p : points) {
                const Eigen::Vector2d q(c * p.x() - s * p.y(), s * p.x() + c * p.y());
                low = low.cwiseMin(q), high = high.cwiseMax(q);
            }
            smallest = std::min(smallest, (high - low).prod());
        }
        align_to_box(points);
        EXPECT_LE(size_of(points).prod(), 1.011 * smallest) << n;
    }
}

TEST(Align, DegenerateSetsPass) {
    Points line{{1, 1}, {2, 2}, {3, 3}};
    align_to_box(line);
    EXPECT_NEAR(size_of(line).x(), std::sqrt(8.0), 1e-9);
    Points dot{{4, 2}, {4, 2}};
    align_to_box(dot);
    EXPECT_NEAR(size_of(dot).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace lumel
