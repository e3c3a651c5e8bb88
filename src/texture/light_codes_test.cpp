#include "texture/light_codes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace lumel {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Colours over many stops, one channel much darker than the others in some.
std::vector<Vec3> colors(float lowest, float highest) {
    std::mt19937 random(1);
    const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-32f; };
    std::vector<Vec3> out;
    for (int i = 0; i < 2000; ++i) {
        const float level = lowest * std::pow(highest / lowest, uniform());
        out.push_back(Vec3{uniform(), uniform(), uniform()} * level);
    }
    return out;
}

// The largest error of any channel, relative to the brightest of its colour.
template <class Encode, class Decode>
float worst_error(const std::vector<Vec3>& colors, Encode encode, Decode decode) {
    float worst = 0.0f;
    for (const Vec3 v : colors) {
        const Vec3 off = decode(encode(v)) - v;
        worst = std::max(worst, max_component(max(off, -off)) / std::max(max_component(v), 1e-30f));
    }
    return worst;
}

TEST(LightCodes, Rgb9e5IsThatOfTheSpecification) {
    // 1 = 256 / 2^9 x 2^1: exponent 1 + 15.
    EXPECT_EQ(encode_rgb9e5({1, 1, 1}), 16u << 27 | 256u << 18 | 256u << 9 | 256u);
    EXPECT_EQ(encode_rgb9e5({1, 0.5f, 0.25f}), 16u << 27 | 64u << 18 | 128u << 9 | 256u);
    EXPECT_EQ(encode_rgb9e5({65408.0f, 0, 0}), 31u << 27 | 511u);
    EXPECT_EQ(encode_rgb9e5({1e9f, -1, kNan}), 31u << 27 | 511u);
    EXPECT_EQ(encode_rgb9e5({0x1p-24f, 0, 0}), 1u) << "the smallest step";
    EXPECT_EQ(encode_rgb9e5({}), 0u);
    // 0.9995 x 2^9 rounds to 2^9: the next exponent.
    EXPECT_EQ(decode_rgb9e5(encode_rgb9e5({0.9995f, 0, 0})).x, 1.0f);
    EXPECT_LE(worst_error(colors(1e-2f, 6e4f), encode_rgb9e5, decode_rgb9e5), 0.5f / 256 + 1e-6f)
        << "half a step of the least mantissa";
}

TEST(LightCodes, RgbmTakesTheLeastMultiplier) {
    EXPECT_EQ(encode_rgbm({1, 0.5f, 0}), (PixelBytes{255, 128, 0, 255}));
    EXPECT_EQ(encode_rgbm({0.1f, 0.1f, 0.1f}), (PixelBytes{250, 250, 250, 26})) << "0.1 x 255 = 25.5";
    EXPECT_EQ(encode_rgbm({}), (PixelBytes{0, 0, 0, 0}));
    EXPECT_EQ(encode_rgbm({kNan, -1, 7}), (PixelBytes{0, 0, 255, 255}));
    // Colours that fill at least half of a multiplier of 2 or more: half a step of 1/255.
    EXPECT_LE(worst_error(colors(0.01f, 1.0f), encode_rgbm, decode_rgbm), 1.0f / 255 + 1e-6f);
}

TEST(LightCodes, RgbdIsThatOfBabylon) {
    EXPECT_EQ(encode_rgbd({1, 1, 1}), (PixelBytes{255, 255, 255, 255}));
    EXPECT_EQ(encode_rgbd({255, 0, 0}), (PixelBytes{255, 0, 0, 1}));
    EXPECT_EQ(encode_rgbd({kNan, -1, 1e9f}), (PixelBytes{0, 0, 255, 1}));
    EXPECT_EQ(encode_rgbd({0.5f, 0, 0})[0], 186) << "255 x 0.5^(1/2.2)";
    // Gamma 2.2 turns half a step into 1.1 of them; where the divisor was rounded down the byte is larger than half.
    EXPECT_LE(worst_error(colors(0.3f, 250.0f), encode_rgbd, decode_rgbd), 0.02f);
}

TEST(LightCodes, LogLuvHoldsTheLogarithmOfLuminance) {
    // Y of white is 0.339 + 0.678 + 0.113 = 1.13: 2 log2 + 127 = 127.3526; 0.3526 x 255 = 89.9.
    const PixelBytes white = encode_logluv({1, 1, 1});
    EXPECT_EQ(white[2], 127);
    EXPECT_EQ(white[3], 90);
    EXPECT_EQ(encode_logluv({}), (PixelBytes{0, 0, 0, 0}));
    EXPECT_EQ(decode_logluv({0, 0, 0, 0}).x, 0.0f);
    EXPECT_EQ(encode_logluv({kNan, -1, 0}), (PixelBytes{0, 0, 0, 0}));
    // A step of the logarithm is 0.14 %; chromaticity of eight bits is what shows: less so in grey than in blue.
    EXPECT_LE(
        worst_error({{1, 1, 1}, {40, 41, 42}, {1e-4f, 1e-4f, 1e-4f}, {6e4f, 6e4f, 6e4f}}, encode_logluv, decode_logluv),
        0.02f);
    EXPECT_LE(worst_error(colors(1e-4f, 6e4f), encode_logluv, decode_logluv), 0.06f);
}

TEST(LightCodes, RgbeIsThatOfRadiance) {
    EXPECT_EQ(encode_rgbe({1, 0.5f, 0.25f}), (PixelBytes{128, 64, 32, 129}));
    EXPECT_EQ(encode_rgbe({}), (PixelBytes{0, 0, 0, 0}));
    EXPECT_EQ(encode_rgbe({0.999f, 0, 0}), (PixelBytes{128, 0, 0, 129})) << "rounds up to the next exponent";
    EXPECT_EQ(encode_rgbe({-1, kNan, 2}), (PixelBytes{0, 0, 128, 130}));
    EXPECT_LE(worst_error(colors(1e-8f, 1e8f), encode_rgbe, decode_rgbe), 0.5f / 128 + 1e-6f);
}

}  // namespace
}  // namespace lumel
