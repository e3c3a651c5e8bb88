#include "chart/chart_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "support/chart_checker.h"
#include "support/statistics.h"

namespace lumel {
namespace {

ChartMask mask_of(const std::vector<UvTriangle>& uv, Vec2 low, Vec2 high, std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint32_t> all(uv.size());
    std::iota(all.begin(), all.end(), 0u);
    return make_mask(all, uv, low, high, width, height);
}

std::string drawing(const ChartMask& mask) {
    std::string out;
    for (std::uint32_t y = 0; y < mask.height; ++y) {
        for (std::uint32_t x = 0; x < mask.width; ++x) out += mask.get(x, y) ? '#' : '.';
        out += '\n';
    }
    return out;
}

// A rectangle whose box is fitted to texel centres takes its steps plus one in each direction, and all of them.
TEST(ChartMask, RectanglesTakeNoTexelTooMany) {
    const std::vector<UvTriangle> quad{{{{1, 2}, {4, 2}, {4, 4}}}, {{{1, 2}, {4, 4}, {1, 4}}}};
    for (const auto& [w, h] : {std::pair{2u, 2u}, {4u, 3u}, {64u, 2u}, {65u, 7u}, {200u, 130u}}) {
        const ChartMask mask = mask_of(quad, {1, 2}, {4, 4}, w, h);
        EXPECT_EQ(mask.used, std::uint64_t{w} * h) << w << "x" << h;
    }
}

// By hand: corners on the centres of texels (0,0), (4,0) and (0,4), in steps: (0,0), (4,0), (0,4). Box (i, j) reaches
// from i - 1 to i + 1; its corner nearest to the origin is (i - 1, j - 1), below the long side x + y = 4 while
// i + j < 6.
TEST(ChartMask, TriangleByHand) {
    const ChartMask mask = mask_of({{{{0, 0}, {1, 0}, {0, 1}}}}, {0, 0}, {1, 1}, 5, 5);
    EXPECT_EQ(drawing(mask), std::string("#####\n#####\n####.\n###..\n##...\n")) << drawing(mask);
    for (std::uint32_t y = 0; y < 5; ++y)
        for (std::uint32_t x = 0; x < 5; ++x) EXPECT_EQ(mask.get(x, y), x + y < 6) << x << " " << y;
}

// Random triangles against the separating axes of the checker.
TEST(ChartMask, AgreesWithBoxTest) {
    test::Random random(11);
    std::uint64_t used = 0, doubtful = 0;
    for (int n = 0; n < 300; ++n) {
        const std::uint32_t width = 2 + random.bits() % 90, height = 2 + random.bits() % 20;
        UvTriangle t;
        for (Vec2& p : t) p = random.pair();
        Vec2 low = t[0], high = t[0];
        for (const Vec2 p : t) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        const ChartMask mask = mask_of({t}, low, high, width, height);
        const TexelMap map = fit_to_centres(low, high, width, height, 0, 0);
        test::detail::Corners corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = {t[k].x * map.scale_x + map.offset_x, t[k].y * map.scale_y + map.offset_y};
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                // The mask leaves out what is touched by less than 1e-4 of a texel: neither answer is wrong there.
                const bool surely = test::detail::meets_square(corners, {x + 0.5, y + 0.5}, 1.0 - 2e-4);
                const bool maybe = test::detail::meets_square(corners, {x + 0.5, y + 0.5}, 1.0 + 2e-4);
                if (surely == maybe) {
                    EXPECT_EQ(mask.get(x, y), surely) << n << ": " << x << " " << y;
                }
                doubtful += surely != maybe;
                used += mask.get(x, y);
            }
    }
    EXPECT_GT(used, 50000u);
    EXPECT_LT(doubtful, used / 50);
}

// Charts without width or height still own 2 x 2 texels.
TEST(ChartMask, LinesAndPointsHaveTexels) {
    EXPECT_EQ(mask_of({{{{1, 1}, {2, 1}, {3, 1}}}}, {1, 1}, {3, 1}, 9, 2).used, 9u);
    EXPECT_EQ(mask_of({{{{1, 1}, {1, 1}, {1, 1}}}}, {1, 1}, {1, 1}, 2, 2).used, 1u);
}

// Half of a square of 8 x 8 steps: the lookups of its long side touch a diagonal of texels more than it covers.
TEST(ChartMask, CountsTheTexelsThatTheChartCoversItself) {
    const std::vector<std::uint32_t> all{0};
    const std::vector<UvTriangle> uv{{Vec2{0, 0}, {8, 0}, {0, 8}}};
    const ChartMask mask = make_mask(all, uv, {0, 0}, {8, 8}, 9, 9);
    // Rows of 9, 8 .. 1; the diagonal x + y = 8 passes through the centres of its 9 texels. Lookups there reach the
    // next diagonal, of 8 texels.
    EXPECT_EQ(mask.covered, 45u);
    EXPECT_EQ(mask.used, 53u);
}

// ---- Rules ----------------------------------------------------------------------------------------------------------

using Filter = MaskRule::Filter;

// Points of a triangle and the texels of every mip that the filter weighs there, by its definition: 2 x 2 or 4 x 4
// texels around the point. All of them must lie in cells of the mask.
TEST(MaskRule, HoldsEveryTexelThatALookupTouches) {
    test::Random random(21);
    std::uint64_t tested = 0;
    for (const Filter filter : {Filter::bilinear, Filter::bicubic})
        for (const std::uint32_t mips : {0u, 1u, 3u})
            for (const std::uint32_t block : {1u, 4u}) {
                const MaskRule rule{filter, mips, block};
                for (int n = 0; n < 30; ++n) {
                    const std::uint32_t width = 2 + random.bits() % 50, height = 2 + random.bits() % 50;
                    const UvTriangle t{random.pair(), random.pair(), random.pair()};
                    const Vec2 low{std::min({t[0].x, t[1].x, t[2].x}), std::min({t[0].y, t[1].y, t[2].y})};
                    const Vec2 high{std::max({t[0].x, t[1].x, t[2].x}), std::max({t[0].y, t[1].y, t[2].y})};
                    const std::vector<std::uint32_t> all{0};
                    const ChartMask mask = make_mask(all, std::span(&t, 1), low, high, width, height, rule);
                    ASSERT_EQ(mask.width, rule.cells(width));
                    const TexelMap map =
                        fit_to_centres(low, high, width, height, rule.inset() - 0.5, rule.inset() - 0.5);
                    for (int k = 0; k < 60; ++k) {
                        const float a = k < 3 ? 0.0f : random.unit(), b = k < 3 ? 0.0f : (1.0f - a) * random.unit();
                        const auto mix = [&](float p, float q, float r) {
                            return double{p + (q - p) * a + (r - p) * b};
                        };
                        const auto c = static_cast<std::size_t>(k % 3);
                        const Vec2 p0 = t[c], p1 = t[(c + 1) % 3], p2 = t[(c + 2) % 3];
                        const double x = mix(p0.x, p1.x, p2.x) * map.scale_x + map.offset_x;
                        const double y = mix(p0.y, p1.y, p2.y) * map.scale_y + map.offset_y;
                        for (std::uint32_t mip = 0; mip <= mips; ++mip) {
                            const double side = std::exp2(mip);
                            // Masks leave out what is reached by less than 1e-4 of a texel of the lowest mip.
                            const double reach = rule.reach() - 2e-4 * rule.mip_texel() / side;
                            for (double j = std::floor(y / side - 0.5) - 1; j <= y / side + 2; ++j)
                                for (double i = std::floor(x / side - 0.5) - 1; i <= x / side + 2; ++i) {
                                    if (std::abs(i + 0.5 - x / side) >= reach || std::abs(j + 0.5 - y / side) >= reach)
                                        continue;
                                    ++tested;
                                    ASSERT_TRUE(i >= 0 && j >= 0);
                                    const auto u = static_cast<std::uint32_t>(i * side / rule.cell());
                                    const auto v = static_cast<std::uint32_t>(j * side / rule.cell());
                                    ASSERT_TRUE(u < mask.width && v < mask.height && mask.get(u, v))
                                        << rule.reach() << " " << mips << " " << block << ": " << i << " " << j;
                                }
                        }
                    }
                }
            }
    EXPECT_GT(tested, 100000u);
}

// Rectangles by hand: no cell more than the filter needs.
TEST(MaskRule, RectanglesTakeNoCellTooMany) {
    const std::vector<UvTriangle> quad{{{{1, 2}, {4, 2}, {4, 4}}}, {{{1, 2}, {4, 4}, {1, 4}}}};
    const std::vector<std::uint32_t> all{0, 1};
    const auto cells = [&](const MaskRule& rule, std::uint32_t width, std::uint32_t height) {
        const ChartMask mask = make_mask(all, quad, {1, 2}, {4, 4}, width, height, rule);
        EXPECT_EQ(mask.used, std::uint64_t{mask.width} * mask.height);
        EXPECT_EQ(mask.covered, std::uint64_t{width} * height);
        return std::array{mask.width, mask.height};
    };
    using Cells = std::array<std::uint32_t, 2>;
    EXPECT_EQ(cells({Filter::bicubic, 0, 1}, 5, 9), (Cells{7, 11}));   // a texel on each side
    EXPECT_EQ(cells({Filter::bilinear, 0, 4}, 2, 5), (Cells{1, 2}));   // the smallest chart is one block
    EXPECT_EQ(cells({Filter::bilinear, 2, 1}, 9, 10), (Cells{3, 4}));  // 8 steps are two texels of mip 2, 9 are more
    EXPECT_EQ(cells({Filter::bicubic, 1, 4}, 2, 2), (Cells{2, 2}));    // two texels of mip 1 and two around them
}

TEST(MaskRule, WhatFitsAPageFitsIt) {
    for (const Filter filter : {Filter::bilinear, Filter::bicubic})
        for (const std::uint32_t mips : {0u, 1u, 3u})
            for (const std::uint32_t block : {1u, 4u})
                for (const std::uint32_t page : {64u, 100u, 257u}) {
                    const MaskRule rule{filter, mips, block};
                    const std::uint32_t texels = rule.texels_within(page);
                    EXPECT_LE(rule.cells(texels) * rule.cell(), page);
                    EXPECT_GT(rule.cells(texels + 1) * rule.cell(), page / rule.cell() * rule.cell());
                }
}

}  // namespace
}  // namespace lumel
