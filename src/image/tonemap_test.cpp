#include "image/tonemap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "image/colormap.h"

namespace lumel {
namespace {

TEST(Srgb, StandardValuesAndRoundTrip) {
    EXPECT_NEAR(srgb_encode(0.5f), 0.735357f, 1e-5);  // IEC 61966-2-1
    EXPECT_EQ(srgb8(1.0f), 255);
    EXPECT_EQ(srgb8(7.0f), 255);
    EXPECT_EQ(srgb8(-1.0f), 0);
    EXPECT_EQ(srgb8(std::numeric_limits<float>::quiet_NaN()), 0);
    for (int code = 0; code < 256; ++code) EXPECT_EQ(srgb8(srgb_decode(float(code) / 255)), code);
}

TEST(ToneCurve, KeepsDarkColoursAndRollsOffTowardsWhite) {
    const Vec3 dark{0.7f, 0.2f, 0.05f};
    EXPECT_EQ(tone_curve(dark), dark);
    const Vec3 bright = tone_curve(Vec3{40, 2, 1});
    EXPECT_LT(max_component(bright), 1.0f);
    EXPECT_GT(bright.y, 0.5f);  // whitened
    float last = 0.0f;
    for (float v = 0.0f; v < 10.0f; v += 0.01f) {
        const float y = tone_curve(Vec3{v, v, v}).x;
        EXPECT_GE(y, last);
        last = y;
    }
}

TEST(AutoExposure, BringsThePercentileToTheTarget) {
    Image image(100, 1, 3);
    for (std::uint32_t x = 0; x < 100; ++x)
        for (int c = 0; c < 3; ++c) image.at(x, 0)[c] = float(x + 1);
    // 75 % of 1..100 lies at 75.25; luminance weights sum to 1.
    EXPECT_NEAR(auto_exposure(image), 0.5 / 75.25, 1e-6);
    std::vector<std::uint8_t> mask(100, 0);
    mask[9] = 1;
    EXPECT_NEAR(auto_exposure(image, mask), 0.05, 1e-6);
    EXPECT_EQ(auto_exposure(Image(4, 4, 3)), 1.0f);
}

TEST(AutoExposure, MostlyBlackPicturesShowTheirLight) {
    Image image(1000, 1, 1);
    image.at(3, 0)[0] = 8.0f;
    EXPECT_NEAR(auto_exposure(image), 0.5 / 8.0, 1e-6);
}

TEST(Tonemap, GreyAndColour) {
    Image grey(1, 1, 1), color(1, 1, 4);
    grey.data = {0.25f};
    color.data = {1, 0, 0, 0.5f};
    const auto g = tonemap(grey, 2.0f);
    EXPECT_EQ(g, (std::vector<std::uint8_t>{188, 188, 188}));  // sRGB of 0.5
    const auto c = tonemap(color, 0.5f);
    EXPECT_EQ(c, (std::vector<std::uint8_t>{188, 0, 0}));
}

TEST(HeatColor, BrightnessRises) {
    float last = -1.0f;
    for (int i = 0; i <= 100; ++i) {
        const Vec3 c = heat_color(float(i) / 100);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_GE(c[k], 0.0f);
            EXPECT_LE(c[k], 1.0f);
        }
        EXPECT_GT(luminance(c), last) << i;
        last = luminance(c);
    }
}

TEST(IdentityColor, NeighboursDiffer) {
    std::set<std::tuple<float, float, float>> seen;
    for (std::uint64_t id = 0; id < 100; ++id) {
        const Vec3 a = identity_color(id), b = identity_color(id + 1);
        EXPECT_GT(length(a - b), 0.15f) << id;
        seen.insert({a.x, a.y, a.z});
    }
    EXPECT_EQ(seen.size(), 100u);
}

}  // namespace
}  // namespace lumel
