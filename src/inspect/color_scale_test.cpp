// Numbers to colours: where the ends of a scale lie, and what its middle is.
#include "inspect/color_scale.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "image/colormap.h"
#include "image/tonemap.h"

namespace lumel {
namespace {

TexelLayer layer_of(ColorRule rule, std::size_t channels = 1) {
    TexelLayer layer{"test", "numbers", "m", rule, {}, {}, false};
    layer.channels.assign(channels, "Y");
    return layer;
}

// A row of texels with these numbers, channel after channel.
LayerPage row(const TexelLayer& layer, const std::vector<float>& values) {
    const auto width = static_cast<std::uint32_t>(values.size() / layer.channels.size());
    LayerPage page(width, 1, layer);
    page.values.data = values;
    page.presence.assign(width, Presence::covered);
    return page;
}

Vec3 color_of(const ColorScale& scale, float v) { return scale.color(std::array{v}); }

TEST(ColorScale, HeatRunsFromZeroToWhatIsUsual) {
    const TexelLayer layer = layer_of(ColorRule::heat);
    std::vector<float> values(1000, 2.0f);
    values[7] = 1e6f;  // an outlier does not flatten it
    values[9] = NAN;
    const ColorScale scale(layer, std::vector{row(layer, values)});
    EXPECT_EQ(scale.low(), 0.0f);
    EXPECT_EQ(scale.high(), 2.0f);
    EXPECT_EQ(color_of(scale, 0.0f), heat_color(0.0f));
    EXPECT_EQ(color_of(scale, 1.0f), heat_color(0.5f));
    EXPECT_EQ(color_of(scale, 1e6f), heat_color(1.0f));
}

TEST(ColorScale, LogarithmicHeatHasTheMedianInTheMiddle) {
    const TexelLayer layer = layer_of(ColorRule::log_heat);
    const ColorScale scale(layer, std::vector{row(layer, {0.0f, 0.5f, 0.5f, 0.5f, 8.0f})});
    EXPECT_FLOAT_EQ(scale.low(), 0.125f);
    EXPECT_FLOAT_EQ(scale.high(), 2.0f);
    EXPECT_FLOAT_EQ(scale.value_at(0.5f), 0.5f);
    EXPECT_EQ(color_of(scale, 0.5f), heat_color(0.5f));
    EXPECT_EQ(color_of(scale, 0.0f), heat_color(0.0f));
}

TEST(ColorScale, WhatHasASignIsGreyAtZero) {
    const TexelLayer layer = layer_of(ColorRule::around_zero);
    const ColorScale scale(layer, std::vector{row(layer, {-4.0f, 1.0f, 2.0f})});
    EXPECT_EQ(scale.low(), -scale.high());
    EXPECT_EQ(color_of(scale, 0.0f), (Vec3{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(color_of(scale, -scale.high()), Vec3{});
    EXPECT_EQ(color_of(scale, scale.high()), (Vec3{1, 1, 1}));
}

TEST(ColorScale, PlacesLieWithinTheBoundsOfAllPages) {
    const TexelLayer layer = layer_of(ColorRule::place, 3);
    const ColorScale scale(layer, std::vector{row(layer, {1, 2, 3}), row(layer, {3, 2, 7})});
    EXPECT_EQ(scale.origin(), (Vec3{1, 2, 3}));
    EXPECT_EQ(scale.high(), 4.0f);
    EXPECT_EQ(scale.color(std::array{3.0f, 2.0f, 7.0f}), (Vec3{0.5f, 0.0f, 1.0f}));
}

// Twice the light at half the exposure: the picture is the same.
TEST(ColorScale, LightIsExposedAsAWhole) {
    const TexelLayer layer = layer_of(ColorRule::light, 3);
    const ColorScale dim(layer, std::vector{row(layer, {1, 1, 1, 2, 2, 2, 3, 3, 3})});
    const ColorScale bright(layer, std::vector{row(layer, {2, 2, 2, 4, 4, 4, 6, 6, 6})});
    EXPECT_FLOAT_EQ(dim.exposure(), 2.0f * bright.exposure());
    EXPECT_EQ(dim.color(std::array{1.5f, 1.0f, 0.5f}), bright.color(std::array{3.0f, 2.0f, 1.0f}));
}

// Empty texels say nothing of the scale.
TEST(ColorScale, OnlyTexelsWithANumberCount) {
    const TexelLayer layer = layer_of(ColorRule::heat);
    LayerPage page = row(layer, {1.0f, 1.0f, 1.0f, 100.0f});
    page.presence[3] = Presence::none;
    EXPECT_EQ(ColorScale(layer, std::vector{page}).high(), 1.0f);
    page.presence[3] = Presence::dilated;
    page.drop_dilated();
    EXPECT_EQ(page.presence[3], Presence::none);
    EXPECT_EQ(page.values.data[3], 0.0f);
    EXPECT_GT(ColorScale(layer, std::vector<LayerPage>{}).high(), 0.0f);  // no division by it
}

}  // namespace
}  // namespace lumel
