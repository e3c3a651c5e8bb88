#include "bc/bc1.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/subset_fit.h"
#include "support/block_pictures.h"

namespace lumel {
namespace {

using namespace bc_test;

// End points white and black, indices 0 1 2 3 in the first row.
TEST(Bc1Decoder, HasFourColoursOrThreeAndTransparent) {
    const BcBlock8 four = {0xFF, 0xFF, 0x00, 0x00, 0b11100100, 0, 0, 0};
    const auto a = decode_bc1_block(four);
    EXPECT_FLOAT_EQ(a[0], 1.0f);
    EXPECT_FLOAT_EQ(a[4], 0.0f);
    EXPECT_FLOAT_EQ(a[8], 2.0f / 3.0f);
    EXPECT_FLOAT_EQ(a[12], 1.0f / 3.0f);
    const BcBlock8 three = {0x00, 0x00, 0xFF, 0xFF, 0b11100100, 0, 0, 0};
    const auto b = decode_bc1_block(three);
    EXPECT_FLOAT_EQ(b[8], 0.5f);
    EXPECT_FLOAT_EQ(b[12], 0.0f);
    EXPECT_FLOAT_EQ(b[15], 0.0f);
    EXPECT_FLOAT_EQ(b[11], 1.0f);
}

TEST(Bc4Decoder, HasEightStepsOrSixAndTheExtremes) {
    const BcBlock8 seven = {255, 0, 0b11'010'001, 0, 0, 0, 0, 0};  // indices 1, 2, ...
    EXPECT_FLOAT_EQ(decode_bc4_block(seven)[0], 0.0f);
    EXPECT_FLOAT_EQ(decode_bc4_block(seven)[1], 6.0f / 7.0f);
    const BcBlock8 five = {51, 204, 0b10'111'110, 0, 0, 0, 0, 0};  // 6, 7, 2
    EXPECT_FLOAT_EQ(decode_bc4_block(five)[0], 0.0f);
    EXPECT_FLOAT_EQ(decode_bc4_block(five)[1], 1.0f);
    EXPECT_FLOAT_EQ(decode_bc4_block(five)[2], (4 * 51.0f + 204.0f) / 5.0f / 255.0f);
}

TEST(Bc1, ErrorIsSmallOpaqueAndFallsWithQuality) {
    Context context(2);
    const Image image = coded_picture(64, 64, 3, 1);
    const std::vector<float> ones(64 * 64, 1.0f);
    const auto error = [&](BcQuality quality) {
        const Image got = decode_bc1(encode_bc1(image, {}, {quality}, context).value(), 64, 64);
        for (std::size_t i = 3; i < got.data.size(); i += 4) EXPECT_EQ(got.data[i], 1.0f);
        return weighted_error(got, image, ones, plain);
    };
    const double normal = error(BcQuality::normal);
    EXPECT_LT(normal, 0.02);  // the spacing of 5-bit end points is 0.03
    EXPECT_LE(normal, error(BcQuality::fast));
    EXPECT_LE(error(BcQuality::best), normal);
}

// Between two end points there are constants that 5:6:5 bits do not have.
TEST(Bc1, FindsConstantsBetweenItsEndPoints) {
    Context context(1);
    Image image(4, 4, 3);
    image.data.assign(48, 103.0f / 255.0f);
    const Image got = decode_bc1(encode_bc1(image, {}, {}, context).value(), 4, 4);
    // Five bits alone have 98.7 and 106.9; with the thirds between them the spacing is 2.74.
    EXPECT_NEAR(got.data[0], 103.0f / 255.0f, 1.4f / 255.0f);
    EXPECT_NEAR(got.data[1], 103.0f / 255.0f, 0.7f / 255.0f);
}

TEST(Bc4, ErrorIsThatOfItsSteps) {
    Context context(1);
    Image image(64, 64, 2);
    for (std::uint32_t i = 0; i < 64 * 64; ++i) {
        image.data[2 * i] = 0.2f + 0.005f * static_cast<float>(i % 64);
        image.data[2 * i + 1] = i % 8 < 4 ? 0.0f : 0.3f + 0.01f * static_cast<float>(i / 64 % 4);
    }
    const std::vector<float> ones(64 * 64, 1.0f);
    for (const BcQuality quality : {BcQuality::fast, BcQuality::normal, BcQuality::best}) {
        const Image got = decode_bc5(encode_bc5(image, {}, {quality}, context).value(), 64, 64);
        EXPECT_LT(weighted_error(got, image, ones, plain), 0.005);
        Image one(64, 64, 1);
        for (std::size_t i = 0; i < one.data.size(); ++i) one.data[i] = image.data[2 * i];
        const Image single = decode_bc4(encode_bc4(one, {}, {quality}, context).value(), 64, 64);
        for (std::size_t i = 0; i < one.data.size(); ++i) ASSERT_EQ(single.data[i], got.data[2 * i]);
    }
}

TEST(Bc1AndBc4AndBc5, OnlyRatiosOfWeightsCount) {
    Context context(1);
    const Image image = coded_picture(32, 32, 3, 5);
    for (const float scale : kScales) {
        const std::vector<float> weights = mixed_weights(32 * 32, 1.0f), scaled = mixed_weights(32 * 32, scale);
        EXPECT_EQ(encode_bc1(image, scaled, {}, context).value(), encode_bc1(image, weights, {}, context).value());
        EXPECT_EQ(encode_bc4(image, scaled, {}, context).value(), encode_bc4(image, weights, {}, context).value());
        EXPECT_EQ(encode_bc5(image, scaled, {}, context).value(), encode_bc5(image, weights, {}, context).value());
    }
}

// Least squares for codes that lie on a palette of thirds finds its end points; 64ths miss them by a code.
TEST(Bc1, ThirdsAreFittedAsThirds) {
    bc::Lanes x = {}, weight = {};
    weight.fill(1.0f / 16);
    for (unsigned i = 0; i < 16; ++i) x.set(i, i < 8 ? 90.0f : (i < 12 ? 170.0f : 250.0f));  // 10 + 80 k, k = 1, 2, 3
    bc::Lanes index = {};
    for (unsigned i = 0; i < 16; ++i) index.set(i, i < 8 ? 1.0f : (i < 12 ? 2.0f : 3.0f));
    bc::Subset<1> subset;
    bc::make_subset(&x, weight, subset);
    bc::Quadratic<1> q;
    bc::EndPair<1> ends;
    bc::make_quadratic<bc::Palette::exact>(subset, index, 3.0f, q);
    bc::solve(subset, q, ends);
    EXPECT_NEAR(ends.a[0], 10.0f, 0.01f);  // roundings of sums of squares of some 200
    EXPECT_NEAR(ends.b[0], 250.0f, 0.01f);
    bc::make_quadratic(subset, index, 3.0f, q);
    bc::solve(subset, q, ends);
    EXPECT_GT(std::fabs(ends.a[0] - 10.0f), 0.5f);
}

TEST(Bc4, TexelsOfWeightZeroAreNeverRead) {
    Context context(1);
    Image image = coded_picture(32, 32, 1, 3);
    const std::vector<float> weights = chart_weights(32, 32);
    const auto four = encode_bc4(image, weights, {}, context), one = encode_bc1(image, weights, {}, context);
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] == 0.0f) image.data[i] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(four.value(), encode_bc4(image, weights, {}, context).value());
    EXPECT_EQ(one.value(), encode_bc1(image, weights, {}, context).value());
}

}  // namespace
}  // namespace lumel
