#include "chart/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/statistics.h"

namespace lumel {
namespace {

// Area of the common part by clipping one triangle with the other's edges (Sutherland and Hodgman): another way than
// the separating axes of the search.
double common_area(const UvTriangle& a, UvTriangle b) {
    if (uv_cross(b) < 0.0) std::swap(b[1], b[2]);
    std::vector<std::array<double, 2>> polygon;
    for (const Vec2 p : a) polygon.push_back({p.x, p.y});
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 p = b[k], q = b[(k + 1) % 3];
        const auto side = [&](const std::array<double, 2>& v) {
            return (double{q.x} - p.x) * (v[1] - p.y) - (double{q.y} - p.y) * (v[0] - p.x);
        };
        std::vector<std::array<double, 2>> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const auto &u = polygon[i], &v = polygon[(i + 1) % polygon.size()];
            const double su = side(u), sv = side(v);
            if (su >= 0.0) kept.push_back(u);
            if ((su < 0.0) != (sv < 0.0)) {
                const double t = su / (su - sv);
                kept.push_back({u[0] + t * (v[0] - u[0]), u[1] + t * (v[1] - u[1])});
            }
        }
        polygon = kept;
    }
    double area = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto &u = polygon[i], &v = polygon[(i + 1) % polygon.size()];
        area += 0.5 * (u[0] * v[1] - u[1] * v[0]);
    }
    return std::abs(area);
}

constexpr OverlapTolerance kStrict{0x1p-20, 0x1p-20, 0.0};

// 400 random triangles: the search finds exactly the pairs whose common part is not tiny.
TEST(Overlap, AgreesWithClipping) {
    test::Random random(3);
    std::vector<UvTriangle> triangles(400);
    for (UvTriangle& t : triangles) {
        const Vec2 centre = random.pair();
        for (Vec2& p : t) p = centre + (random.pair() - Vec2{0.5f, 0.5f}) * 0.15f;
    }
    auto found = find_overlaps(triangles, kStrict, 1000000).pairs;
    std::sort(found.begin(), found.end());
    std::size_t sure = 0;
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (std::uint32_t j = i + 1; j < triangles.size(); ++j) {
            const double area = common_area(triangles[i], triangles[j]);
            const bool listed = std::binary_search(found.begin(), found.end(), std::array<std::uint32_t, 2>{i, j});
            if (area == 0.0) {
                EXPECT_FALSE(listed) << i << " " << j;
            }
            if (area > 1e-7) {
                EXPECT_TRUE(listed) << i << " " << j << " " << area;
            }
            sure += area > 1e-7;
        }
    EXPECT_GT(sure, 500u);
}

// Neighbours in a grid turned by an odd angle share edges and corners and nothing else.
TEST(Overlap, NeighboursDoNotOverlap) {
    constexpr int kN = 30;
    const auto point = [](int i, int j) {
        const float x = static_cast<float>(i) / kN, y = static_cast<float>(j) / kN;
        return Vec2{0.1f + 0.7f * x - 0.21f * y, 0.2f + 0.21f * x + 0.7f * y};
    };
    std::vector<UvTriangle> triangles;
    for (int j = 0; j < kN; ++j)
        for (int i = 0; i < kN; ++i) {
            triangles.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1)});
            triangles.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
        }
    EXPECT_TRUE(find_overlaps(triangles, kStrict, 10).pairs.empty());
    triangles.push_back({point(3, 3), point(4, 3), point(4, 4)});
    EXPECT_EQ(find_overlaps(triangles, kStrict, 10).pairs.size(), 1u);
}

TEST(Overlap, ToleranceIsTheNarrowerOfBoth) {
    const UvTriangle large{{{0, 0}, {1, 0}, {0, 1}}}, beside{{{0, -1}, {1, 0.001f}, {0, 0.001f}}};
    EXPECT_EQ(find_overlaps(std::vector{large, beside}, {0x1p-20, 0.01, 0.1}, 9).pairs.size(), 0u);
    EXPECT_EQ(find_overlaps(std::vector{large, beside}, {0x1p-20, 0.0001, 0.1}, 9).pairs.size(), 1u);
    // Far smaller than the absolute tolerance, and one on top of the other.
    const UvTriangle tiny{{{0.5f, 0.5f}, {0.501f, 0.5f}, {0.5f, 0.501f}}};
    EXPECT_EQ(find_overlaps(std::vector{tiny, tiny}, {0x1p-20, 0.01, 0.1}, 9).pairs.size(), 1u);
}

TEST(Overlap, CentreIsInTheMiddleOfWhatIsShared) {
    // The square [0.5, 1] x [0, 0.5] cut by the diagonal of the first: corners (0.5, 0), (1, 0), (0.5, 0.5).
    const UvTriangle a{{{0, 0}, {1, 0}, {0, 1}}}, b{{{0.5f, 0}, {0.5f, 2}, {2.5f, 0}}};
    for (const Vec2 centre : {overlap_centre(a, b), overlap_centre(b, a), overlap_centre({a[0], a[2], a[1]}, b)}) {
        EXPECT_NEAR(centre.x, 2.0f / 3.0f, 1e-6f);
        EXPECT_NEAR(centre.y, 1.0f / 6.0f, 1e-6f);
    }
}

// A palette: all triangles in one place make n^2 / 2 pairs; the search must stop at its limit, and triangles without
// area must not be compared at all.
TEST(Overlap, StopsAtTheLimit) {
    std::vector<UvTriangle> triangles(100000, {{{0.1f, 0.1f}, {0.2f, 0.1f}, {0.1f, 0.2f}}});
    const OverlapSearch search = find_overlaps(triangles, kStrict, 50);
    EXPECT_EQ(search.pairs.size(), 50u);
    EXPECT_FALSE(search.complete);
    std::fill(triangles.begin(), triangles.end(), UvTriangle{{{0.1f, 0.1f}, {0.1f, 0.1f}, {0.1f, 0.1f}}});
    EXPECT_TRUE(find_overlaps(triangles, kStrict, 50).complete);
}

}  // namespace
}  // namespace lumel
