// Cells, coverage and point location of one triangle, against the separating axis test and exact cases.
#include "texel/texel_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/statistics.h"

namespace lumel {
namespace {

using Corners = std::array<Vec2, 3>;

// Separating axes: does the triangle meet the square [x + margin, x + 1 - margin] x ...? Closed sets.
bool meets_square(const Corners& triangle, int x, int y, double margin) {
    const double low_x = x + margin, high_x = x + 1 - margin, low_y = y + margin, high_y = y + 1 - margin;
    const auto separates = [&](double nx, double ny) {
        double low = 1e300, high = -1e300;
        for (const Vec2 p : triangle) {
            low = std::min(low, nx * p.x + ny * p.y);
            high = std::max(high, nx * p.x + ny * p.y);
        }
        const double square_low = std::min(nx * low_x, nx * high_x) + std::min(ny * low_y, ny * high_y);
        const double square_high = std::max(nx * low_x, nx * high_x) + std::max(ny * low_y, ny * high_y);
        return high < square_low || low > square_high;
    };
    if (separates(1, 0) || separates(0, 1)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 a = triangle[i], b = triangle[(i + 1) % 3];
        const double nx = double{a.y} - b.y, ny = double{b.x} - a.x;
        if ((nx != 0 || ny != 0) && separates(nx, ny)) return false;
    }
    return true;
}

bool covers(const Corners& triangle, int x, int y, std::uint32_t size) {
    const TexelTriangle t(triangle);
    const CellRange rows = t.rows(size);
    if (y < rows.first || y >= rows.end) return false;
    const CellRange columns = t.columns(y, size);
    return x >= columns.first && x < columns.end;
}

std::size_t count_covered(const Corners& triangle, std::uint32_t size) {
    const TexelTriangle t(triangle);
    std::size_t count = 0;
    const CellRange rows = t.rows(size);
    for (std::int32_t y = rows.first; y < rows.end; ++y) {
        const CellRange columns = t.columns(y, size);
        count += static_cast<std::size_t>(std::max(0, columns.end - columns.first));
    }
    return count;
}

// Every texel that the triangle reaches into by more than a touch, and none that it does not meet.
TEST(TexelTriangle, CoversWhatItReachesInto) {
    constexpr int kSize = 24;
    test::Random random(1);
    for (int round = 0; round < 3000; ++round) {
        // Large, small (below a texel), and slivers down to 1e-5 texels wide.
        const float scale = round % 3 == 1 ? 0.5f : 16.0f;
        const Vec2 corner = random.pair() * 8.0f;
        Corners triangle{corner, corner + random.pair() * scale, corner + random.pair() * scale};
        if (round % 3 == 2)
            triangle[2] = triangle[0] + (triangle[1] - triangle[0]) * random.unit() +
                          (random.pair() - Vec2{0.5f, 0.5f}) * std::pow(10.0f, -5.0f * random.unit());
        ASSERT_GT(count_covered(triangle, kSize), 0u);
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const bool covered = covers(triangle, x, y, kSize);
                // 1.5: a corner of the square can be cut off by the touch along x and along y together.
                ASSERT_TRUE(covered || !meets_square(triangle, x, y, 1.5 * kTouch)) << round << ": " << x << " " << y;
                ASSERT_TRUE(!covered || meets_square(triangle, x, y, -1e-9)) << round << ": " << x << " " << y;
            }
    }
}

TEST(TexelTriangle, AlignedSquareCoversItsTexelsOnly) {
    const Corners lower{Vec2{2, 3}, {5, 3}, {5, 7}}, upper{Vec2{2, 3}, {5, 7}, {2, 7}};
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x) {
            const bool inside = x >= 2 && x < 5 && y >= 3 && y < 7;
            EXPECT_EQ(covers(lower, x, y, 10) || covers(upper, x, y, 10), inside) << x << " " << y;
        }
}

TEST(TexelTriangle, DegenerateTrianglesCoverATexel) {
    EXPECT_EQ(count_covered({Vec2{3.5f, 4.5f}, {3.5f, 4.5f}, {3.5f, 4.5f}}, 10), 1u);
    EXPECT_EQ(count_covered({Vec2{3, 4}, {3, 4}, {3, 4}}, 10), 1u);
    EXPECT_EQ(count_covered({Vec2{1.5f, 4.5f}, {6.5f, 4.5f}, {3.5f, 4.5f}}, 10), 6u);  // a level line through 6 texels
    EXPECT_EQ(count_covered({Vec2{1.5f, 1.5f}, {4.5f, 4.5f}, {2.5f, 2.5f}}, 10), 4u);
    EXPECT_EQ(count_covered({Vec2{1.5f, 4}, {6.5f, 4}, {3.5f, 4}}, 10), 6u);  // along the line between two rows
}

TEST(TexelTriangle, StaysOnThePage) {
    const TexelTriangle t({Vec2{-5, -3}, {40, 2}, {3, 60}});
    EXPECT_EQ(t.rows(16).first, 0);
    EXPECT_EQ(t.rows(16).end, 16);
    for (int y = 0; y < 16; ++y) {
        EXPECT_GE(t.columns(y, 8).first, 0);
        EXPECT_LE(t.columns(y, 8).end, 8);
    }
    EXPECT_EQ(count_covered({Vec2{-9, -9}, {-3, -9}, {-3, -2}}, 16), 0u);
    EXPECT_EQ(count_covered({Vec2{20, 20}, {30, 20}, {30, 30}}, 16), 0u);
    EXPECT_EQ(covers({Vec2{8, 8}, {16, 8}, {16, 16}}, 15, 15, 16), true);  // ends on the border of the page
}

TEST(TexelTriangle, LocatesByBarycentrics) {
    test::Random random(2);
    for (int round = 0; round < 20000; ++round) {
        const Corners c{random.pair() * 100.0f, random.pair() * 100.0f, random.pair() * 100.0f};
        const Vec2 u = random.pair();
        const double b1 = u.x * (1 - u.y), b2 = u.y, b0 = 1 - b1 - b2;
        const double x = b0 * c[0].x + b1 * c[1].x + b2 * c[2].x, y = b0 * c[0].y + b1 * c[1].y + b2 * c[2].y;
        const double area = std::fabs(cross(c[1] - c[0], c[2] - c[0]));
        if (area < 1.0 || std::min({b0, b1, b2}) < 1e-6) continue;
        const auto found = TexelTriangle(c).locate(x, y);
        ASSERT_TRUE(found) << round;
        EXPECT_NEAR(found->b1, b1, 1e-6);  // the rounding of barycentrics to float
        EXPECT_NEAR(found->b2, b2, 1e-6);
        EXPECT_LE(found->b1 + found->b2, 1.0f);
        // Mirrored through an edge it lies outside.
        EXPECT_FALSE(TexelTriangle(c).locate(c[0].x + c[1].x - x, c[0].y + c[1].y - y));
    }
}

// A fan of triangles around a point covers the plane without cracks, whatever the rounding: points exactly on, or as
// near as doubles allow to, the shared edges.
TEST(TexelTriangle, NeighboursLeaveNoCrack) {
    test::Random random(3);
    for (int round = 0; round < 20000; ++round) {
        const Vec2 a = random.pair() * 7.0f, b = random.pair() * 7.0f;
        const Vec2 left = random.pair() * 7.0f, right = random.pair() * 7.0f;
        const Vec2 along = b - a;
        if (!(cross(along, left - a) > 0.1f && cross(along, right - a) < -0.1f)) continue;
        const TexelTriangle one({a, b, left}), two({b, a, right});
        const double t = 0.01 + 0.98 * random.unit();
        double x = a.x + t * along.x, y = a.y + t * along.y;
        for (int nudge = 0; nudge < 4; ++nudge) {
            ASSERT_TRUE(one.locate(x, y) || two.locate(x, y)) << round;
            x = std::nextafter(x, 10.0);
            y = std::nextafter(y, nudge % 2 == 0 ? 10.0 : -10.0);
        }
    }
}

TEST(TexelTriangle, PartOfATexelHasItsMiddleInside) {
    // Half of texel (2, 2), below its diagonal.
    const TexelTriangle half({Vec2{2, 2}, {3, 2}, {3, 3}});
    const auto part = half.part_in(2, 2);
    EXPECT_NEAR(part.area, 0.5, 1e-12);
    EXPECT_NEAR(part.middle.b1, 1.0f / 3, 1e-6f);
    EXPECT_NEAR(part.middle.b2, 1.0f / 3, 1e-6f);
    EXPECT_NEAR(TexelTriangle({Vec2{0, 0}, {9, 0}, {0, 9}}).part_in(1, 1).area, 1.0, 1e-12);
    // A line: no area, its middle within the texel.
    const auto line = TexelTriangle({Vec2{1, 2.5f}, {5, 2.5f}, {3, 2.5f}}).part_in(4, 2);
    EXPECT_EQ(line.area, 0.0);
    const float b0 = 1 - line.middle.b1 - line.middle.b2;
    const float x = b0 * 1 + line.middle.b1 * 5 + line.middle.b2 * 3;
    EXPECT_GE(x, 4.0f);
    EXPECT_LE(x, 5.0f);
}

}  // namespace
}  // namespace lumel
