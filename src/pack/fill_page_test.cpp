#include "pack/fill_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pack/pack_pages.h"
#include "pack/sweep.h"
#include "support/pack_checker.h"
#include "support/random_masks.h"

namespace lumel {
namespace {

std::uint64_t used_by(const std::vector<ChartMask>& masks) {
    return std::accumulate(masks.begin(), masks.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const ChartMask& m) { return sum + m.used; });
}

test::PackConflicts check(const std::vector<ChartMask>& masks, const PagePacking& packing) {
    std::vector<test::PackedSpot> spots;
    for (const PackedChart& c : packing.charts) spots.push_back({c.page, c.x, c.y, c.orientation});
    test::PackConflicts out = test::draw_packing(masks, spots, packing.width);
    EXPECT_EQ(out.drawn, used_by(masks));
    EXPECT_EQ(out.overlaps, 0u);
    EXPECT_EQ(out.outside, 0u);
    EXPECT_EQ(out.heights.size(), packing.pages.size());
    for (std::size_t p = 0; p < packing.pages.size(); ++p) EXPECT_EQ(out.heights[p], packing.pages[p].height);
    return out;
}

PagePacking pack_with(const std::vector<ChartMask>& masks, PackOptions options, unsigned threads = 1) {
    Context context(threads);
    PagePacking packing = pack_pages(masks, options, context);
    EXPECT_TRUE(packing.complete);
    return packing;
}

double efficiency(const PagePacking& packing) {
    double used = 0.0, area = 0.0;
    for (const PackedPage& page : packing.pages) {
        used += static_cast<double>(page.used);
        area += static_cast<double>(packing.width) * page.height;
    }
    return used / area;
}

TEST(PackPages, NothingOverlapsWhateverTheOrientations) {
    const std::vector<ChartMask> masks = test::random_masks(1500, 90, 1);
    for (const Orientations orientations : {Orientations::automatic, Orientations::one, Orientations::eight}) {
        PackOptions options;
        options.orientations = orientations;
        const PagePacking packing = pack_with(masks, options);
        ASSERT_EQ(packing.pages.size(), 1u);
        check(masks, packing);
        const bool turned =
            std::ranges::any_of(packing.charts, [](const PackedChart& c) { return c.orientation != 0; });
        EXPECT_EQ(turned, orientations != Orientations::one);
    }
}

// Denser than the published method on the same charts, turned or not.
TEST(PackPages, BeatsTheSweep) {
    const std::vector<ChartMask> masks = test::random_masks(4000, 120, 2);
    std::vector<std::uint32_t> all(masks.size());
    std::iota(all.begin(), all.end(), 0u);
    Context context(1);
    const std::uint32_t width = default_width(masks);
    const PageFill sweep = sweep_page(masks, all, width, context);
    ASSERT_EQ(sweep.placed, masks.size());
    const double published = static_cast<double>(sweep.used) / (static_cast<double>(width) * sweep.height);
    PackOptions options;
    options.orientations = Orientations::one;
    // When this was written: sweep 90.4 %, not turned 94.0 %, turned 96.9 %.
    const double plain = efficiency(pack_with(masks, options));
    EXPECT_GT(plain, published + 0.01);
    options.orientations = Orientations::automatic;
    EXPECT_GT(efficiency(pack_with(masks, options)), plain);
}

// A room: few charts, the largest of them rectangles. They must not be kept for the end, when they only fit below.
TEST(PackPages, LargeRectanglesAreNotLeftForTheEnd) {
    std::vector<ChartMask> masks = test::random_masks(150, 60, 7);
    for (const std::uint32_t size : {150u, 130u, 90u, 70u}) masks.push_back(test::rectangle_mask(size, 3 * size / 4));
    std::vector<std::uint32_t> all(masks.size());
    std::iota(all.begin(), all.end(), 0u);
    PackOptions options;
    options.orientations = Orientations::one;
    const PagePacking packing = pack_with(masks, options);
    check(masks, packing);
    Context context(1);
    EXPECT_LE(packing.pages[0].height, sweep_page(masks, all, packing.width, context).height);
}

TEST(PackPages, PagesAreFilledInTurn) {
    const std::vector<ChartMask> masks = test::random_masks(3000, 60, 3);
    PackOptions options;
    options.max_page = 128;
    const PagePacking packing = pack_with(masks, options);
    check(masks, packing);
    EXPECT_GE(packing.pages.size(), 3u);
    EXPECT_EQ(packing.width, 128u);
    for (std::size_t p = 0; p + 1 < packing.pages.size(); ++p) {
        EXPECT_LE(packing.pages[p].height, 128u);
        EXPECT_GT(packing.pages[p].used, 128u * 128u * 9 / 10) << p;
    }
}

TEST(PackPages, SameForAnyNumberOfThreads) {
    const std::vector<ChartMask> masks = test::random_masks(1200, 60, 4);
    const PagePacking one = pack_with(masks, {}, 1), eight = pack_with(masks, {}, 8);
    EXPECT_EQ(one.width, eight.width);
    for (std::size_t i = 0; i < masks.size(); ++i) {
        EXPECT_EQ(one.charts[i].x, eight.charts[i].x);
        EXPECT_EQ(one.charts[i].y, eight.charts[i].y);
        EXPECT_EQ(one.charts[i].orientation, eight.charts[i].orientation);
    }
}

// Boxes that are not tight, charts of one texel, charts as wide as the page or wider than high.
TEST(PackPages, OddCharts) {
    std::vector<ChartMask> masks;
    ChartMask hollow(6, 6), corner(8, 8), lines(3, 200);
    hollow.set(3, 4);
    corner.set(7, 0);
    for (std::uint32_t y = 1; y < 200; y += 2) lines.set_span(y, 1, 2);
    for (ChartMask* m : {&hollow, &corner, &lines}) m->used = m->count();
    for (int i = 0; i < 20; ++i) {
        masks.push_back(hollow);
        masks.push_back(corner);
        masks.push_back(lines);
        masks.push_back(test::rectangle_mask(1, 1));
        masks.push_back(test::rectangle_mask(300, 1));
        masks.push_back(test::rectangle_mask(1, 300));
    }
    for (const Orientations orientations : {Orientations::one, Orientations::automatic}) {
        PackOptions options;
        options.width = 300;
        options.max_page = 300;
        options.orientations = orientations;
        check(masks, pack_with(masks, options));
    }
}

TEST(PackPages, StopsWhenAsked) {
    Context context(1);
    context.request_cancel();
    EXPECT_FALSE(pack_pages(test::random_masks(100, 60, 5), {}, context).complete);
}

TEST(PackPages, NothingIsNoPage) { EXPECT_TRUE(pack_with({}, {}).pages.empty()); }

// What does not fit stays out, and the page is not higher than asked.
TEST(FillPage, LeavesOutWhatDoesNotFit) {
    const std::vector<ChartMask> masks = test::random_masks(600, 60, 6);
    std::vector<std::uint32_t> all(masks.size());
    std::iota(all.begin(), all.end(), 0u);
    Context context(1);
    FillOptions options;
    options.width = options.height = 64;
    const PageFill fill = fill_page(masks, all, options, context);
    EXPECT_LE(fill.height, 64u);
    EXPECT_LT(fill.placed, masks.size());
    EXPECT_GT(fill.used, 64u * 64u * 92 / 100);  // 94.5 % when this was written
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count_if(fill.spots, &PageSpot::placed)), fill.placed);
}

}  // namespace
}  // namespace lumel
