#include "post/mip.h"

#include <gtest/gtest.h>

namespace lumel {
namespace {

// Texel i lies at the i-th pixel that is not '.', of the chart of that digit; its light is i + 1.
Lightmap page_of(const std::vector<std::string>& rows) {
    Lightmap map;
    map.width = static_cast<std::uint32_t>(rows[0].size());
    map.height = static_cast<std::uint32_t>(rows.size());
    for (const std::string& row : rows)
        for (const char c : row) {
            map.texel_at.push_back(c == '.' ? kNone : static_cast<std::uint32_t>(map.chart.size()));
            if (c != '.') map.chart.push_back(static_cast<std::uint32_t>(c - '0'));
        }
    const std::size_t texels = map.chart.size();
    map.texels.resize(texels);
    map.coverage.assign(texels, Coverage::baked);
    map.surface.albedo.assign(texels, Vec3{0.5f, 0.5f, 0.5f});
    map.surface.emission.assign(texels, Vec3{});
    map.normal.assign(texels, Vec3{0, 0, 1});
    for (std::size_t i = 0; i < texels; ++i) {
        map.texels.layers[i][0].irradiance = map.texels.layers[i][0].sh[4] = Vec3{static_cast<float>(i + 1), 0, 0};
        map.texels.variance[i] = {4, 4, 4};
        map.texels.count[i] = 10;
    }
    return map;
}

Lightmap mip_of(const Lightmap& page, std::uint32_t mip, const std::vector<std::uint32_t>& readers,
                std::uint32_t rings = 0) {
    Context context(1);
    return make_mip(page, mip, readers, rings, context).value();
}

float light(const Lightmap& map, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t texel = map.texel_at[y * map.width + x];
    return texel == kNone ? -1.0f : map.texels.layers[texel][0].irradiance.x;
}

TEST(Mip, ATexelIsTheMeanOfWhatIsCovered) {
    // Texels 1 2 3 / 4 5: the second column of blocks has one texel alone.
    const Lightmap mip = mip_of(page_of({"000.", "00..", "....", "...."}), 1, {0, 0, kNone, kNone});
    EXPECT_EQ(mip.mip, 1u);
    EXPECT_EQ(mip.width, 2u);
    EXPECT_FLOAT_EQ(light(mip, 0, 0), (1 + 2 + 4 + 5) / 4.0f);
    EXPECT_FLOAT_EQ(light(mip, 1, 0), 3.0f) << "what is not covered is no black";
    EXPECT_FLOAT_EQ(light(mip, 0, 1), -1.0f);
    EXPECT_FLOAT_EQ(mip.texels.layers[0][0].sh[4].x, 3.0f);
    EXPECT_FLOAT_EQ(mip.texels.variance[0].x, 1.0f) << "of the mean of four";
    EXPECT_EQ(mip.texels.count[0], 40u);
    EXPECT_EQ(mip.coverage[0], Coverage::baked);
}

TEST(Mip, LowerMipsAreMadeFromThePageItself) {
    const Lightmap page = page_of({"0000", "0...", "0...", "...."});
    EXPECT_FLOAT_EQ(light(mip_of(page, 2, {0}), 0, 0), (1 + 2 + 3 + 4 + 5 + 6) / 6.0f);
}

TEST(Mip, DilatedTexelsDoNotCountAndLookupsFindTheirRing) {
    Lightmap page = page_of({"0000", "0000", "....", "...."});
    for (const std::uint32_t texel : {2u, 3u, 6u, 7u}) page.coverage[texel] = Coverage::dilated;
    EXPECT_FLOAT_EQ(light(mip_of(page, 1, {0, 0, 0, 0}), 1, 0), -1.0f);
    const Lightmap mip = mip_of(page, 1, {0, 0, 0, 0}, 1);
    for (const auto& [x, y] : {std::array{1u, 0u}, std::array{0u, 1u}, std::array{1u, 1u}}) {
        EXPECT_FLOAT_EQ(light(mip, x, y), (1 + 2 + 5 + 6) / 4.0f);
        EXPECT_EQ(mip.coverage[mip.texel_at[y * 2 + x]], Coverage::dilated);
    }
}

// Behind a wall: what leaks is left out where there is anything else, and refilled from inside its chart where not.
TEST(Mip, LeaksAreRefilledFromTheirChart) {
    Lightmap page = page_of({"0000..11", "0000..11"});  // 1 2 3 4 . . 5 6 / 7 8 9 10 . . 11 12
    page.leaks.assign(12, 0);
    for (const std::uint32_t texel : {1u, 2u, 3u, 8u, 9u}) page.leaks[texel] = 1;  // all of the second texel of mip 1
    const Lightmap mip = mip_of(page, 1, {0, 0, kNone, 1});
    EXPECT_FLOAT_EQ(light(mip, 0, 0), (1 + 7 + 8) / 3.0f);
    EXPECT_FLOAT_EQ(light(mip, 1, 0), light(mip, 0, 0));
    EXPECT_EQ(mip.coverage[mip.texel_at[1]], Coverage::filled);
    EXPECT_FLOAT_EQ(light(mip, 3, 0), (5 + 6 + 11 + 12) / 4.0f);
    page.leaks.assign(12, 1);
    EXPECT_FLOAT_EQ(light(mip_of(page, 1, {0, 0, kNone, 1}), 1, 0), (3 + 4 + 9 + 10) / 4.0f) << "nothing else is there";
}

// A layout that is not for this mip: the texel is that of the chart that reads it.
TEST(Mip, ATexelNeverMixesCharts) {
    const Lightmap page = page_of({"01", "11"});
    EXPECT_FLOAT_EQ(light(mip_of(page, 1, {0}), 0, 0), 1.0f);
    EXPECT_FLOAT_EQ(light(mip_of(page, 1, {1}), 0, 0), 3.0f);
}

}  // namespace
}  // namespace lumel
