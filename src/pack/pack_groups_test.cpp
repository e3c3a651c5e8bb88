#include "pack/pack_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/pack_checker.h"
#include "support/random_masks.h"

namespace lumel {
namespace {

// Charts in order, a new group as soon as one has so many texels.
struct Set {
    std::vector<ChartMask> masks;
    std::vector<std::uint32_t> group_of;
    std::uint32_t groups = 0;

    Set(std::size_t charts, std::uint32_t largest, std::uint64_t texels)
        : masks(test::random_masks(charts, largest, 5)) {
        std::uint64_t used = texels;
        for (const ChartMask& mask : masks) {
            if (used >= texels) {
                ++groups;
                used = 0;
            }
            used += mask.used;
            group_of.push_back(groups - 1);
        }
    }
};

GroupPacking pack_with(const Set& set, const GroupOptions& options, unsigned threads = 1) {
    Context context(threads);
    GroupPacking out = pack_groups(set.masks, set.group_of, set.groups, options, context);
    EXPECT_TRUE(out.complete);
    return out;
}

void expect_sound(const Set& set, const GroupPacking& packing) {
    for (std::uint32_t g = 0; g < set.groups; ++g) {
        std::vector<ChartMask> masks;
        std::vector<test::PackedSpot> spots;
        std::uint64_t used = 0;
        for (std::size_t i = 0; i < set.masks.size(); ++i) {
            if (set.group_of[i] != g) continue;
            EXPECT_EQ(packing.charts[i].page, g);
            masks.push_back(set.masks[i]);
            used += masks.back().used;
            spots.push_back({0, packing.charts[i].x, packing.charts[i].y, packing.charts[i].orientation});
        }
        const GroupPage& page = packing.groups[g];
        EXPECT_EQ(page.used, used);
        const test::PackConflicts conflicts = test::draw_packing(masks, spots, page.width);
        EXPECT_EQ(conflicts.overlaps + conflicts.outside, 0u) << "group " << g;
        EXPECT_EQ(conflicts.drawn, used);
        ASSERT_EQ(conflicts.heights.size(), 1u);
        EXPECT_LE(conflicts.heights[0], page.height);
    }
}

// What a system of radiosity, or a cell that is streamed, has: some 106 x 106 texels. At least nine of ten are of use.
TEST(PackGroups, AtlasesOfAHundredTexelsAreDense) {
    const Set set(3000, 40, 10'600);
    ASSERT_GE(set.groups, 5u);
    const GroupPacking packing = pack_with(set, {});
    expect_sound(set, packing);
    for (std::uint32_t g = 0; g + 1 < set.groups; ++g) {  // the last one is what was left
        const GroupPage& page = packing.groups[g];
        EXPECT_GE(static_cast<double>(page.used) / static_cast<double>(page.area()), 0.90)
            << page.width << "x" << page.height;
        EXPECT_LT(std::max(page.width, page.height), 2 * std::min(page.width, page.height));
    }
}

TEST(PackGroups, KeepsToMultiplesAndToTheLargestPage) {
    const Set set(600, 30, 4'000);
    GroupOptions options;
    options.multiple = 4;
    options.max_page = 82;
    const GroupPacking packing = pack_with(set, options);
    expect_sound(set, packing);
    for (const GroupPage& page : packing.groups) {
        EXPECT_EQ(page.width % 4 + page.height % 4, 0u);
        EXPECT_LE(std::max(page.width, page.height), 80u);
    }
    options.max_page = 40;
    EXPECT_FALSE(pack_with(set, options).too_large.empty());
}

TEST(PackGroups, AGroupMayHaveNoCharts) {
    Context context(1);
    const std::vector<ChartMask> masks{test::rectangle_mask(5, 3)};
    const GroupPacking packing = pack_groups(masks, std::vector<std::uint32_t>{1}, 3, {}, context);
    EXPECT_TRUE(packing.complete && packing.too_large.empty());
    EXPECT_EQ(packing.groups[0].area() + packing.groups[2].area(), 0u);
    EXPECT_EQ(packing.groups[1].area(), 15u);
}

TEST(PackGroups, SameBitsForAnyNumberOfThreads) {
    const Set set(800, 40, 5'000);
    const GroupPacking one = pack_with(set, {}, 1), eight = pack_with(set, {}, 8);
    for (std::size_t i = 0; i < set.masks.size(); ++i) {
        EXPECT_EQ(one.charts[i].x, eight.charts[i].x);
        EXPECT_EQ(one.charts[i].y, eight.charts[i].y);
        EXPECT_EQ(one.charts[i].orientation, eight.charts[i].orientation);
    }
}

}  // namespace
}  // namespace lumel
