#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "post/lightmap.h"

namespace lumel {
namespace {

// A page with texels at the given pixels; texel i has irradiance value[i] in every layer's first channel; value < 0
// means invalid (its rays met backs).
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
            buffer.chart.push_back(0);
            buffer.normal.push_back(i % 2 == 0 ? Vec3{0.6f, 0, 0.8f} : Vec3{-0.6f, 0, 0.8f});
            buffer.texel_at[std::size_t{pixels[i][1]} * width + pixels[i][0]] = static_cast<std::uint32_t>(i);
            sums.count[i] = 10;
            sums.open[i] = value[i] < 0.0f ? 4 : 5;  // exactly half is valid still
            for (LayerMoments& layer : sums.layers[i]) layer.irradiance.x = std::max(0.0f, value[i]);
            surface.albedo.push_back({static_cast<float>(i), 0, 0});
            surface.emission.push_back({});
        }
    }
    Lightmap finish(std::uint32_t rings) {
        Context context(1);
        return finish_page(buffer, sums, surface, readers, rings, context).value();
    }
    std::vector<std::uint32_t> readers;
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
        ASSERT_EQ(map.normal.size(), map.texels.size());
        for (const Vec3& n : map.normal) EXPECT_NEAR(length(n), 1.0f, 1e-6f);
    }
}

TEST(FinishPage, FillsFromItsOwnChartAlone) {
    Page page(3, 1, {{0, 0}, {1, 0}, {2, 0}}, {2.0f, -1.0f, 4.0f});
    page.buffer.chart = {5, 5, 1};
    EXPECT_FLOAT_EQ(irradiance(page.finish(0), 1, 0), 2.0f);
    page.buffer.chart = {5, 3, 1};
    EXPECT_EQ(coverage(page.finish(0), 1, 0), Coverage::none) << "a chart of its own without any light";
}

// Row 0 is two charts; below it: pixels of one chart's light each, by majority, the lower id where they tie.
TEST(FinishPage, DilatesWithTheLightOfOneChart) {
    Page page(5, 3, {{0, 0}, {1, 0}, {3, 0}, {4, 0}}, {2.0f, 2.0f, 8.0f, 8.0f});
    page.buffer.chart = {7, 7, 4, 4};
    Lightmap map = page.finish(2);
    for (const std::uint32_t y : {1u, 2u})
        for (std::uint32_t x = 0; x < 5; ++x) {
            const bool left = x < 2;  // column 2 is a tie: chart 4
            EXPECT_FLOAT_EQ(irradiance(map, x, y), left ? 2.0f : 8.0f) << x << " " << y;
            EXPECT_EQ(map.chart[map.texel_at[y * 5 + x]], left ? 7u : 4u);
        }
    // Most neighbours, though of the higher id: column 2 has chart 9 above it and to one side.
    Page most(3, 2, {{0, 0}, {1, 0}, {2, 0}}, {8.0f, 2.0f, 2.0f});
    most.buffer.chart = {4, 9, 9};
    map = most.finish(1);
    EXPECT_FLOAT_EQ(irradiance(map, 1, 1), 2.0f);
}

// A pixel that bilinear lookups of a chart read belongs to it, however many neighbours another has.
TEST(FinishPage, DilationObeysTheReaderOfAPixel) {
    Page page(3, 3, {{0, 0}, {0, 2}, {1, 2}, {2, 2}}, {1.0f, 5.0f, 5.0f, 5.0f});
    page.buffer.chart = {3, 0, 0, 0};
    EXPECT_FLOAT_EQ(irradiance(page.finish(1), 1, 1), 5.0f);
    page.readers.assign(9, kNone);
    page.readers[4] = 3;
    EXPECT_FLOAT_EQ(irradiance(page.finish(1), 1, 1), 1.0f);
}

// A strip of 60000 texels, filled from one end in as many rings. Looking at all open texels for each takes 2e9 looks.
TEST(FinishPage, FillingLooksAtEachTexelOnce) {
    constexpr std::uint16_t kLength = 60000;
    std::vector<std::array<std::uint16_t, 2>> pixels;
    for (std::uint16_t x = 0; x < kLength; ++x) pixels.push_back({x, 0});
    std::vector<float> value(kLength, -1.0f);
    value[0] = 3.0f;
    Page page(kLength, 1, pixels, value);
    const auto start = std::chrono::steady_clock::now();
    const Lightmap map = page.finish(0);
    // Some 50 ms where each is looked at once; half a minute where not.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_FLOAT_EQ(irradiance(map, kLength - 1, 0), 3.0f);
}

TEST(FinishPage, CancelStopsFillAndDilation) {
    for (const float second : {-1.0f, 2.0f}) {
        Page page(3, 1, {{0, 0}, {1, 0}}, {1.0f, second});
        Context context(1);
        context.request_cancel();
        const auto result = finish_page(page.buffer, page.sums, page.surface, {}, 1, context);
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, ErrorCode::cancelled);
    }
}

// Where the room was made before tracing, the largest array never moves.
TEST(FinishPage, DilationGrowsInPlace) {
    Page page(20, 10, {{0, 0}, {7, 4}, {8, 4}, {19, 9}}, {1.0f, 2.0f, 3.0f, 4.0f});
    for (const std::uint32_t rings : {0u, 1u, 4u, 30u}) {
        const std::size_t room = texels_with_rings(page.buffer, rings);
        EXPECT_EQ(room, page.finish(rings).texels.size());
        RadianceSums sums;
        sums.reserve(room);
        sums.resize(page.sums.size());
        sums.layers.assign(page.sums.layers.begin(), page.sums.layers.end());
        sums.open = page.sums.open;
        sums.count = page.sums.count;
        const auto* before = sums.layers.data();
        Context context(1);
        const auto map = finish_page(page.buffer, std::move(sums), page.surface, {}, rings, context);
        ASSERT_TRUE(map.ok());
        EXPECT_EQ(map->texels.layers.data(), before);
    }
}

TEST(FinishPage, DilationStopsAtThePageBorder) {
    Page page(2, 2, {{0, 0}}, {1.0f});
    EXPECT_EQ(page.finish(5).texels.size(), 4u);
}

}  // namespace
}  // namespace lumel
