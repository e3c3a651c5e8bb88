#include "io/block_sample.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lumel/scene.h"

namespace lumel {
namespace {

// A page in which texel (x, y) has irradiance (x, y, 0); baked but for the last column, which is dilated, and the first
// two rows, which are empty.
MasterPage numbered_page(std::uint32_t width, std::uint32_t height) {
    MasterPage out;
    out.width = width;
    out.height = height;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            if (y < 2) {
                out.texel_at.push_back(kNone);
                continue;
            }
            out.texel_at.push_back(static_cast<std::uint32_t>(out.size()));
            out.coverage.push_back(x + 1 == width ? 1 : 3);
            out.radiance.emplace_back();
            out.irradiance.push_back({static_cast<float>(x), static_cast<float>(y), 0});
            out.normal.push_back({0, 1, 0});
        }
    return out;
}

BlockSample sample_of(const MasterPage& page, std::size_t texels) {
    BlockSampler sampler(texels, 1);
    sampler.add(page);
    return std::move(sampler).finish();
}

TEST(BlockSample, KeepsTexelsInTheirPlacesOfABlock) {
    const BlockSample sample = sample_of(numbered_page(10, 7), 1000);  // all: 3 x 2 blocks, cut by both edges
    EXPECT_EQ(sample.light.size(), 50u);
    EXPECT_EQ(sample.baked.size(), 45u);
    EXPECT_EQ(sample.texels.light.size(), 45u);
    EXPECT_EQ(sample.frame.size(), 50u);
    ASSERT_EQ(sample.page.texel_at.size(), std::size_t{sample.page.width} * sample.page.height);
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < sample.page.texel_at.size(); ++i) {
        const std::uint32_t texel = sample.page.texel_at[i];
        if (texel == kNone) continue;
        ++found;
        const Vec3 at = sample.light[texel].irradiance;
        EXPECT_EQ(static_cast<std::uint32_t>(at.x) % 4, i % sample.page.width % 4);
        EXPECT_EQ(static_cast<std::uint32_t>(at.y) % 4, i / sample.page.width % 4);
    }
    EXPECT_EQ(found, 50u);
    for (const std::uint32_t i : sample.baked) EXPECT_LT(sample.light[i].irradiance.x, 9.0f) << "dilated";
}

TEST(BlockSample, NeighboursAreBakedAndOfOneBlock) {
    const BlockSample sample = sample_of(numbered_page(10, 7), 1000);
    // Columns 0 to 8 of five rows: three pairs in each of the first two blocks, none beside column 8 alone.
    EXPECT_EQ(sample.texels.neighbours.size(), 5u * 6u);
    for (const auto& [a, b] : sample.texels.neighbours) {
        const Vec3 left = sample.texels.light[a].irradiance, right = sample.texels.light[b].irradiance;
        EXPECT_EQ(right.x, left.x + 1);
        EXPECT_EQ(right.y, left.y);
    }
}

TEST(BlockSample, IsSpreadEvenlyAndAsLargeAsWanted) {
    const MasterPage page = numbered_page(64, 66);
    const BlockSample sample = sample_of(page, 400);
    EXPECT_GE(sample.baked.size(), 350u);
    EXPECT_LE(sample.baked.size(), 450u);
    float lowest = 1e9f, highest = 0.0f;
    for (const TexelLight& light : sample.texels.light) {
        lowest = std::min(lowest, light.irradiance.y);
        highest = std::max(highest, light.irradiance.y);
    }
    EXPECT_LT(lowest, 8.0f);
    EXPECT_GT(highest, 56.0f);
    BlockSampler two(400, 2);
    two.add(page);
    two.add(page);
    EXPECT_NEAR(static_cast<double>(std::move(two).finish().baked.size()), 400.0, 50.0);
}

}  // namespace
}  // namespace lumel
