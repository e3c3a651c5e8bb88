#include "path/texel_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/charted_scene.h"

namespace lumel {
namespace {

TEST(TexelBlocks, HoldEachTexelOnceWithItsNeighboursOnOneChart) {
    Context context(1);
    const test::ChartedScene room(test::room(), 6, context);
    const TexelBlocks blocks = make_texel_blocks(room.texels, 0, room.texels.size());
    std::vector<int> seen(room.texels.size(), 0);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const auto block = blocks.block(b);
        ASSERT_FALSE(block.empty());
        ASSERT_LE(block.size(), std::size_t{kBlockEdge} * kBlockEdge);
        for (const std::uint32_t i : block) {
            ++seen[i];
            EXPECT_EQ(room.texels.chart[i], room.texels.chart[block[0]]);
            EXPECT_EQ(room.texels.x[i] / kBlockEdge, room.texels.x[block[0]] / kBlockEdge);
            EXPECT_EQ(room.texels.y[i] / kBlockEdge, room.texels.y[block[0]] / kBlockEdge);
        }
    }
    EXPECT_EQ(seen, std::vector<int>(room.texels.size(), 1));
}

TEST(TexelBlocks, OfARangeAreWholeAndNoMore) {
    Context context(1);
    const test::ChartedScene room(test::room(), 6, context);
    const TexelBlocks all = make_texel_blocks(room.texels, 0, room.texels.size());
    const std::size_t begin = room.texels.size() / 3, end = begin + 5;
    const TexelBlocks some = make_texel_blocks(room.texels, begin, end);
    std::size_t expected = 0;
    for (std::size_t b = 0; b < all.size(); ++b) {
        const auto block = all.block(b);
        if (std::ranges::none_of(block, [&](std::uint32_t i) { return i >= begin && i < end; })) continue;
        ASSERT_LT(expected, some.size());
        EXPECT_TRUE(std::ranges::equal(block, some.block(expected++)));
    }
    EXPECT_EQ(some.size(), expected);
    EXPECT_EQ(make_texel_blocks(room.texels, 7, 7).size(), 0u);
}

TEST(TexelBlocks, ASpreadOfThemComesFromAllOverThePage) {
    Context context(1);
    const test::ChartedScene room(test::room(), 6, context);
    const TexelBlocks all = make_texel_blocks(room.texels, 0, room.texels.size());
    ASSERT_GT(all.size(), 16u);
    const TexelBlocks some = spread_blocks(all, all.texels.size() / 4);
    EXPECT_EQ(some.size(), (all.size() + 1) / 4);
    for (std::size_t b = 0; b < some.size(); ++b) EXPECT_TRUE(std::ranges::equal(some.block(b), all.block(4 * b + 2)));
    EXPECT_EQ(spread_blocks(all, all.texels.size()).texels, all.texels);
    EXPECT_EQ(spread_blocks(all, 1).size(), 1u);
    EXPECT_EQ(spread_blocks(make_texel_blocks(room.texels, 0, 0), 8).size(), 0u);
}

}  // namespace
}  // namespace lumel
