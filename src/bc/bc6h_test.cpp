#include "bc/bc6h.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bc/known_blocks.h"
#include "math/half.h"
#include "support/block_pictures.h"

namespace lumel {
namespace {

using namespace bc_test;

Context& context() {
    static Context the_one(2);
    return the_one;
}

Image there_and_back(const Image& image, const std::vector<float>& weights, const Bc6hOptions& options) {
    const auto blocks = encode_bc6h(image, weights, options, context());
    return decode_bc6h(blocks.value(), image.width, image.height, options.is_signed);
}

TEST(Bc6hDecoder, GivesTheBitsOfAnIndependentOneInEveryMode) {
    for (const auto& known : kKnownBc6hUnsigned) EXPECT_EQ(decode_bc6h_block(known.block, false), known.texels);
    for (const auto& known : kKnownBc6hSigned) EXPECT_EQ(decode_bc6h_block(known.block, true), known.texels);
}

TEST(HalfToFloat, HoldsForKnownCodes) {
    EXPECT_EQ(half_to_float(0x0000), 0.0f);
    EXPECT_EQ(half_to_float(0x0001), 0x1p-24f);
    EXPECT_EQ(half_to_float(0x03FF), 1023 * 0x1p-24f);
    EXPECT_EQ(half_to_float(0x0400), 0x1p-14f);
    EXPECT_EQ(half_to_float(0x3C00), 1.0f);
    EXPECT_EQ(half_to_float(0xC001), -2.0f - 0x1p-9f);
    EXPECT_EQ(half_to_float(0x7BFF), 65504.0f);
    EXPECT_EQ(half_to_float(0x8002), -0x1p-23f);
}

// A constant block is stored in 16 bits: what comes back is within one code, 2^-10 of the value and less.
TEST(Bc6h, KeepsConstantsToOneCode) {
    for (const bool is_signed : {false, true})
        for (const float value : {0.0f, 0.001f, 0.37f, 1.0f, 3.14159f, 65504.0f, 1e9f}) {
            Image image(4, 4, 3);
            image.data.assign(48, value);
            const Image got = there_and_back(image, {}, {BcQuality::fast, is_signed, false});
            for (const float g : got.data)
                EXPECT_NEAR(g, std::min(value, 65504.0f), std::min(value, 65504.0f) * 0x1p-10f);
        }
}

// On this picture mode 11 alone has 0.0066; a broken mode, partition or rounding shows as a several-fold error.
TEST(Bc6h, ErrorIsSmallAndFallsWithQuality) {
    const Image image = lit_picture(64, 64, 3, 1);
    const std::vector<float> ones(64 * 64, 1.0f);
    const auto error = [&](BcQuality quality, bool is_signed, bool only) {
        return weighted_error(there_and_back(image, {}, {quality, is_signed, only}), image, ones, logarithmic);
    };
    const double mode_11 = error(BcQuality::normal, false, true), normal = error(BcQuality::normal, false, false);
    EXPECT_LT(normal, 0.85 * mode_11);
    EXPECT_LT(error(BcQuality::fast, false, false), 1.1 * normal);
    EXPECT_LE(error(BcQuality::best, false, false), 1.001 * normal);
    EXPECT_LT(normal, 0.006);
    EXPECT_LT(error(BcQuality::normal, true, false), 1.1 * normal);
}

TEST(Bc6h, SignedHoldsNegativeValues) {
    Image image = lit_picture(32, 32, 3, 2);
    for (std::size_t i = 0; i < image.data.size(); i += 3) image.data[i] = -image.data[i];
    const Image got = there_and_back(image, {}, {BcQuality::normal, true, false});
    const std::vector<float> ones(32 * 32, 1.0f);
    EXPECT_LT(weighted_error(got, image, ones, logarithmic), 0.03);
    for (std::size_t i = 0; i < got.data.size(); i += 3) EXPECT_LT(got.data[i], 0.0f);
}

TEST(Bc6h, TexelsOfWeightZeroAreNeverRead) {
    Image image = lit_picture(32, 32, 3, 3);
    const std::vector<float> weights = chart_weights(32, 32);
    const auto first = encode_bc6h(image, weights, {}, context());
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] == 0.0f)
            for (std::size_t c = 0; c < 3; ++c)
                image.data[3 * i + c] = i % 2 == 0 ? 1e30f : std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(first.value(), encode_bc6h(image, weights, {}, context()).value());
}

// Black texels that count stretch the palettes of their blocks over all of what half floats hold.
TEST(Bc6h, MasksLowerTheErrorOfWhatCounts) {
    Image image = lit_picture(64, 64, 3, 4);
    const std::vector<float> weights = chart_weights(64, 64);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] *= weights[i / 3];
    const double masked = weighted_error(there_and_back(image, weights, {}), image, weights, logarithmic);
    const double zeros = weighted_error(there_and_back(image, {}, {}), image, weights, logarithmic);
    EXPECT_LT(masked, 0.45 * zeros);
}

TEST(Bc6h, ABlockOfNoneIsBlackAndOddSizesAreWhole) {
    const Image image = lit_picture(5, 3, 3, 5);
    const auto none = encode_bc6h(image, std::vector<float>(15, 0.0f), {}, context());
    ASSERT_EQ(none.value().size(), 32u);
    for (const float g : decode_bc6h(none.value(), 5, 3, false).data) EXPECT_EQ(g, 0.0f);
    const std::vector<float> ones(15, 1.0f);
    EXPECT_LT(weighted_error(there_and_back(image, {}, {}), image, ones, logarithmic), 0.05);
}

TEST(Bc6h, IsTheSameForOneAndForThreeThreads) {
    const Image image = lit_picture(64, 64, 3, 6);
    Context one(1), three(3);
    EXPECT_EQ(encode_bc6h(image, {}, {}, one).value(), encode_bc6h(image, {}, {}, three).value());
}

TEST(Bc6h, SurvivesAnyFloats) {
    test::Random random(7);
    Image image(64, 64, 3);
    for (float& value : image.data) value = std::bit_cast<float>(random.bits());
    std::vector<float> weights(64 * 64);
    for (float& weight : weights) weight = std::bit_cast<float>(random.bits());
    std::vector<float> usable = weights;  // block_image.h
    for (float& weight : usable) weight = weight > 1e-30f ? std::fmin(weight, 1e30f) : 0.0f;
    for (const bool is_signed : {false, true}) {
        const Bc6hOptions options{BcQuality::best, is_signed, false};
        for (const float g : there_and_back(image, weights, options).data) EXPECT_TRUE(std::isfinite(g));
        const Image clean = sanitised(image, is_signed ? -65504.0f : 0.0f, 65504.0f);
        EXPECT_EQ(encode_bc6h(image, weights, options, context()).value(),
                  encode_bc6h(clean, usable, options, context()).value());
    }
}

TEST(Bc6h, OnlyRatiosOfWeightsCount) {
    const Image image = lit_picture(32, 32, 3, 9);
    const auto blocks = [&](float scale) {
        return encode_bc6h(image, mixed_weights(32 * 32, scale), {BcQuality::best, false, false}, context()).value();
    };
    for (const float scale : kScales) EXPECT_EQ(blocks(scale), blocks(1.0f)) << scale;
}

TEST(Bc6h, CanBeCancelled) {
    Context cancelled(1);
    cancelled.request_cancel();
    const auto result = encode_bc6h(lit_picture(16, 16, 3, 8), {}, {}, cancelled);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
