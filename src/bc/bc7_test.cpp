#include "bc/bc7.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "bc/known_blocks.h"
#include "support/block_pictures.h"

namespace lumel {
namespace {

using namespace bc_test;

Image there_and_back(const Image& image, const std::vector<float>& weights, const Bc7Options& options) {
    Context context(2);
    return decode_bc7(encode_bc7(image, weights, options, context).value(), image.width, image.height);
}

TEST(Bc7Decoder, GivesTheCodesOfAnIndependentOneInEveryMode) {
    for (const auto& known : kKnownBc7) EXPECT_EQ(decode_bc7_block(known.block), known.texels);
}

// Mode 6 alone has 0.010 on this picture; a broken mode, partition or rounding shows as a several-fold error.
TEST(Bc7, ErrorIsSmallAndFallsWithQuality) {
    const std::vector<float> ones(64 * 64, 1.0f);
    for (const std::uint32_t channels : {3u, 4u}) {
        const Image image = coded_picture(64, 64, channels, 1);
        const auto error = [&](BcQuality quality, bool only) {
            return weighted_error(there_and_back(image, {}, {quality, only}), image, ones, plain);
        };
        const double mode_6 = error(BcQuality::normal, true), normal = error(BcQuality::normal, false);
        EXPECT_LT(normal, 0.9 * mode_6) << channels;
        EXPECT_LE(normal, 1.001 * error(BcQuality::fast, false)) << channels;
        EXPECT_LE(error(BcQuality::best, false), 1.001 * normal) << channels;
        EXPECT_LT(normal, 0.01) << channels;
    }
}

// Each channel by a pattern of its own: only modes with a separate channel come near.
TEST(Bc7, AChannelOfItsOwnHasIndicesOfItsOwn) {
    Image image(4, 4, 3);
    for (std::uint32_t i = 0; i < 16; ++i) {
        image.data[3 * i] = image.data[3 * i + 2] = static_cast<float>(i / 4) / 3.0f;
        image.data[3 * i + 1] = static_cast<float>(i % 4) / 3.0f;
    }
    const std::vector<float> ones(16, 1.0f);
    EXPECT_LT(weighted_error(there_and_back(image, {}, {}), image, ones, plain), 0.005);
}

TEST(Bc7, WithoutAlphaItIsOpaqueOrNearly) {
    const Image got = there_and_back(coded_picture(32, 32, 3, 2), {}, {BcQuality::best, false});
    for (std::size_t i = 3; i < got.data.size(); i += 4) EXPECT_GE(got.data[i], 254.0f / 255.0f);
}

TEST(Bc7, TexelsOfWeightZeroAreNeverRead) {
    Context context(1);
    Image image = coded_picture(32, 32, 3, 3);
    const std::vector<float> weights = chart_weights(32, 32);
    const auto first = encode_bc7(image, weights, {}, context);
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] == 0.0f) image.data[3 * i] = image.data[3 * i + 1] = 1.0f - image.data[3 * i];
    EXPECT_EQ(first.value(), encode_bc7(image, weights, {}, context).value());
}

TEST(Bc7, SurvivesAnyFloats) {
    test::Random random(7);
    Image image(32, 32, 4);
    for (float& value : image.data) value = std::bit_cast<float>(random.bits());
    const Bc7Options options{BcQuality::best, false};
    Context context(1);
    for (const float g : there_and_back(image, {}, options).data) EXPECT_TRUE(std::isfinite(g));
    EXPECT_EQ(encode_bc7(image, {}, options, context).value(),
              encode_bc7(sanitised(image, 0.0f, 1.0f), {}, options, context).value());
}

TEST(Bc7, OnlyRatiosOfWeightsCount) {
    Context context(1);
    for (const std::uint32_t channels : {3u, 4u}) {
        const Image image = coded_picture(32, 32, channels, 4);
        const auto blocks = [&](float scale) {
            return encode_bc7(image, mixed_weights(32 * 32, scale), {}, context).value();
        };
        for (const float scale : kScales) EXPECT_EQ(blocks(scale), blocks(1.0f)) << scale;
    }
}

}  // namespace
}  // namespace lumel
