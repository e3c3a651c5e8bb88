#include <gtest/gtest.h>

#include <algorithm>

#include "post/lightmap.h"

namespace lumel {
namespace {

// A page with texels at the given pixels; texel i has irradiance value[i] in every layer's first channel; value < 0
// means invalid (all paths void).
struct Page {
    TexelBuffer buffer;
    RadianceSums sums;
    TexelSurface surface;

    Page(std::uint32_t width, std::uint32_t height, const std::vector<std::array<std::uint16_t, 2>>& pixels,
         const std::vector<float>& value) {
        buffer.width = width;
        buffer.height = height;
        buffer.texel_at.assign(std::size_t{width} * height, kNone);
        sums.resize(pixels.size());
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            buffer.x.push_back(pixels[i][0]);
            buffer.y.push_back(pixels[i][1]);
            buffer.texel_at[std::size_t{pixels[i][1]} * width + pixels[i][0]] = static_cast<std::uint32_t>(i);
            sums.traced[i] = 10;
            sums.count[i] = value[i] < 0.0f ? 5 : 6;  // exactly half void is invalid already
            for (LayerMoments& layer : sums.layers[i]) layer.irradiance.x = std::max(0.0f, value[i]);
            surface.albedo.push_back({static_cast<float>(i), 0, 0});
            surface.emission.push_back({});
        }
    }
    Lightmap finish(std::uint32_t rings) { return finish_page(buffer, sums, surface, rings); }
};

float irradiance(const Lightmap& map, std::uint32_t x, std::uint32_t y) {
    return map.texels.layers[map.texel_at[y * map.width + x]][0].irradiance.x;
}
Coverage coverage(const Lightmap& map, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t texel = map.texel_at[y * map.width + x];
    return texel == kNone ? Coverage::none : map.coverage[texel];
}

TEST(FinishPage, InvalidTexelsTakeTheMeanOfTheirValidNeighbours) {
    Page page(3, 1, {{0, 0}, {1, 0}, {2, 0}}, {2.0f, -1.0f, 4.0f});
    const Lightmap map = page.finish(0);
    EXPECT_EQ(coverage(map, 1, 0), Coverage::filled);
    EXPECT_FLOAT_EQ(irradiance(map, 1, 0), 3.0f);
    EXPECT_FLOAT_EQ(map.surface.albedo[1].x, 1.0f) << "a filled texel keeps its own surface";
    EXPECT_EQ(coverage(map, 0, 0), Coverage::baked);
}

// Three invalid texels in a row: the outer two are filled first, each from its own side; the middle one from both.
TEST(FinishPage, FillsRingByRing) {
    Page page(5, 1, {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}, {1.0f, -1.0f, -1.0f, -1.0f, 5.0f});
    const Lightmap map = page.finish(0);
    EXPECT_FLOAT_EQ(irradiance(map, 1, 0), 1.0f);
    EXPECT_FLOAT_EQ(irradiance(map, 3, 0), 5.0f);
    EXPECT_FLOAT_EQ(irradiance(map, 2, 0), 3.0f);
}

TEST(FinishPage, AnIslandWithoutAnyValidTexelStaysUnbaked) {
    Page page(8, 1, {{0, 0}, {5, 0}}, {1.0f, -1.0f});
    const Lightmap map = page.finish(1);
    EXPECT_EQ(coverage(map, 5, 0), Coverage::none);
    EXPECT_EQ(coverage(map, 4, 0), Coverage::none) << "nothing to dilate from";
    EXPECT_EQ(coverage(map, 1, 0), Coverage::dilated);
}

// Black is a colour like any other: coverage decides, so a black baked texel is neither filled nor dilated over.
TEST(FinishPage, BlackBakedTexelsStay) {
    Page page(2, 1, {{0, 0}, {1, 0}}, {0.0f, 8.0f});
    const Lightmap map = page.finish(2);
    EXPECT_EQ(coverage(map, 0, 0), Coverage::baked);
    EXPECT_FLOAT_EQ(irradiance(map, 0, 0), 0.0f);
}

TEST(FinishPage, DilationMakesAsManyRingsAsAsked) {
    Page page(9, 9, {{4, 4}}, {7.0f});
    for (const std::uint32_t rings : {0u, 1u, 3u}) {
        const Lightmap map = page.finish(rings);
        const std::size_t side = 2 * rings + 1;
        EXPECT_EQ(map.texels.size(), side * side);
        for (std::size_t i = 0; i < map.texels.size(); ++i) EXPECT_FLOAT_EQ(map.texels.layers[i][1].irradiance.x, 7.0f);
        EXPECT_EQ(map.surface.albedo.size(), map.texels.size());
    }
}

TEST(FinishPage, DilationStopsAtThePageBorder) {
    Page page(2, 2, {{0, 0}}, {1.0f});
    EXPECT_EQ(page.finish(5).texels.size(), 4u);
}

}  // namespace
}  // namespace lumel
