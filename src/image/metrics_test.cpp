// Figures worked out by hand: small images, exact binary numbers.
#include "image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/hash.h"

namespace lumel {
namespace {

Image grey(std::uint32_t width, std::uint32_t height, std::vector<float> values) {
    Image image(width, height, 1);
    image.data = std::move(values);
    return image;
}

TEST(Metrics, FiguresByHand) {
    // r = 1, 3; x = 2, 3.5: errors 1 and 0.5; mean(r) = 2; floor = 0.01 * 4.
    const ImageMetrics m = compare_images(grey(2, 1, {2, 3.5f}), grey(2, 1, {1, 3}));
    EXPECT_EQ(m.texels, 2u);
    EXPECT_DOUBLE_EQ(m.reference_mean, 2.0);
    EXPECT_DOUBLE_EQ(m.mean, 2.75);
    EXPECT_DOUBLE_EQ(m.nrmse, std::sqrt((1 + 0.25) / 2) / 2);
    EXPECT_DOUBLE_EQ(m.relmse, (1 / 1.04 + 0.25 / 9.04) / 2);
    EXPECT_DOUBLE_EQ(m.bias, 0.75);
    EXPECT_DOUBLE_EQ(m.relative_bias, 0.375);
    EXPECT_DOUBLE_EQ(m.block_bias_p95, 0.375);  // one block
    EXPECT_DOUBLE_EQ(m.median_relative_error, (1 / 1.02 + 0.5 / 3.02) / 2);
    ASSERT_EQ(m.worst.size(), 2u);
    EXPECT_EQ(m.worst[0].x, 0u);
    EXPECT_DOUBLE_EQ(m.worst[0].relative_squared_error, 1 / 1.04);
    EXPECT_EQ(m.worst[0].value[0], 2.0f);
    EXPECT_EQ(m.worst[0].reference[0], 1.0f);
    const double d0 = (std::log(3.0) - std::log(2.0)) / std::log(4.0),
                 d1 = (std::log(4.5) - std::log(4.0)) / std::log(4.0);
    EXPECT_NEAR(m.log_psnr, -10 * std::log10((d0 * d0 + d1 * d1) / 2), 1e-9);
}

TEST(Metrics, EqualImagesHaveNoError) {
    const Image image = grey(2, 2, {1, 2, 3, 4});
    const ImageMetrics m = compare_images(image, image);
    EXPECT_EQ(m.nrmse, 0.0);
    EXPECT_EQ(m.relmse, 0.0);
    EXPECT_EQ(m.block_bias_p95, 0.0);
    EXPECT_EQ(m.median_relative_error, 0.0);
    EXPECT_EQ(m.log_psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, MaskDecidesWhatCounts) {
    const Mask mask{0, 1, 1, 0};
    const ImageMetrics m = compare_images(grey(4, 1, {100, 2, 4, 100}), grey(4, 1, {0, 2, 2, 0}), mask);
    EXPECT_EQ(m.texels, 2u);
    EXPECT_DOUBLE_EQ(m.nrmse, std::sqrt(2.0) / 2);
    EXPECT_EQ(m.worst.at(0).x, 2u);
}

TEST(Metrics, NothingToCompareIsSaid) {
    const ImageMetrics m = compare_images(grey(1, 1, {1}), grey(1, 1, {2}), Mask{0});
    EXPECT_EQ(m.texels, 0u);
    EXPECT_TRUE(m.worst.empty());
}

TEST(Metrics, NonFiniteTexelsMakeTheErrorInfinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const ImageMetrics m = compare_images(grey(2, 1, {nan, 1}), grey(2, 1, {1, 1}));
    EXPECT_EQ(m.non_finite, 1u);
    EXPECT_EQ(m.nrmse, std::numeric_limits<double>::infinity());
    EXPECT_EQ(m.relmse, std::numeric_limits<double>::infinity());
    EXPECT_EQ(m.relmse_without_worst, std::numeric_limits<double>::infinity());
    EXPECT_EQ(m.bias, 0.0);
}

TEST(Metrics, ABlackReferenceIsComparedAbsolutely) {
    const ImageMetrics m = compare_images(grey(2, 1, {3, 4}), grey(2, 1, {0, 0}));
    EXPECT_DOUBLE_EQ(m.nrmse, std::sqrt(12.5));
    EXPECT_TRUE(std::isfinite(m.relmse));
    EXPECT_DOUBLE_EQ(m.bias, 3.5);
}

// 40 x 20 texels make 3 x 2 blocks, the right and lower ones partial. One block is off by +1, one by -2.
TEST(Metrics, BlocksAreSixteenTexelsAndKeepTheirSign) {
    Image reference(40, 20, 3), image(40, 20, 3);
    for (float& v : reference.data) v = 4.0f;
    for (std::uint32_t y = 0; y < 20; ++y)
        for (std::uint32_t x = 0; x < 40; ++x)
            for (std::uint32_t c = 0; c < 3; ++c)
                image.at(x, y)[c] = 4.0f + (x < 16 && y < 16 ? 1.0f : 0.0f) - (x >= 32 && y >= 16 ? 2.0f : 0.0f);
    const ImageMetrics m = compare_images(image, reference);
    // Sorted |bias| / 4: 0 0 0 0 .25 .5; the 95th percentile lies at position 4.75.
    EXPECT_NEAR(m.block_bias_p95, 0.25 + 0.75 * 0.25, 1e-12);
    EXPECT_NEAR(m.bias, (256.0 - 2 * 32) / 800, 1e-12);
    EXPECT_NEAR(m.channel_bias.at(2), (256.0 - 2 * 32) / 800, 1e-12);
}

TEST(Metrics, WorstTexelsComeInOrderAndTiesByPlace) {
    const ImageMetrics m = compare_images(grey(2, 2, {2, 1, 5, 2}), grey(2, 2, {1, 1, 1, 1}), {}, 3);
    ASSERT_EQ(m.worst.size(), 3u);
    EXPECT_EQ(m.worst[0].y, 1u);
    EXPECT_EQ(m.worst[0].x, 0u);
    EXPECT_EQ(m.worst[1].y, 0u);
    EXPECT_EQ(m.worst[2].y, 1u);
}

// The cross score of two noisy halves against the noise-free image has mean zero, where relMSE has that of the noise.
TEST(Metrics, CrossScoreDoesNotSeeTheNoiseOfTheReferences) {
    Image truth(128, 128, 1), a = truth, b = truth;
    for (std::size_t i = 0; i < truth.data.size(); ++i) {
        truth.data[i] = 1.0f;
        a.data[i] = 1.0f + ((mix64(2 * i + 1) >> 63) != 0 ? 0.1f : -0.1f);
        b.data[i] = 1.0f + ((mix64(2 * i + 2) >> 63) != 0 ? 0.1f : -0.1f);
    }
    // Halves agree (++, --) or not, a quarter, a quarter and a half of the time: mean .25(.01/1.22 + .01/.82) -
    // .5(.01/1.01) = 1.5e-4, by the denominator alone. 16384 terms of 0.01: standard error 8e-5; 5 of them.
    EXPECT_NEAR(cross_relmse(truth, a, b), 1.5e-4, 4e-4);
    EXPECT_NEAR(compare_images(truth, a).relmse, 0.01, 1e-3);
    // And sees a true error, x = 1.2 everywhere: .25(.01/1.22 + .09/.82) + .5(.03/1.01).
    Image off = truth;
    for (float& v : off.data) v = 1.2f;
    EXPECT_NEAR(cross_relmse(off, a, b), 0.04434, 1.5e-3);
}

TEST(Metrics, Percentile) {
    std::vector<double> values{5, 1, 3, 2, 4};
    EXPECT_DOUBLE_EQ(percentile(values, 0.0), 1.0);
    EXPECT_DOUBLE_EQ(percentile(values, 0.5), 3.0);
    EXPECT_DOUBLE_EQ(percentile(values, 0.625), 3.5);
    EXPECT_DOUBLE_EQ(percentile(values, 1.0), 5.0);
    EXPECT_EQ(percentile({}, 0.5), 0.0);
}

// A thousandth of a thousand is one, of one more it is two, rounded up.
TEST(Metrics, MeanLeavesOutTheWorstThousandth) {
    std::vector<double> errors(1000, 2.0);
    errors[300] = 1e9;
    EXPECT_DOUBLE_EQ(mean_without_worst(errors), 2.0);
    errors[700] = 1001.0;  // a second one stays: 998 * 2 + 1001 = 2997 over 999
    EXPECT_DOUBLE_EQ(mean_without_worst(errors), 3.0);
    errors.push_back(2.0);
    EXPECT_DOUBLE_EQ(mean_without_worst(errors), 2.0);
    EXPECT_EQ(mean_without_worst({5.0}), 0.0);
    EXPECT_EQ(mean_without_worst({5.0, 1.0}), 1.0);
    EXPECT_EQ(mean_without_worst({}), 0.0);
}

// 40 x 25 texels of 1, all but one 2: their terms are 1 / 1.01.
TEST(Metrics, RelMseWithoutTheWorstTexel) {
    Image reference(40, 25, 1), image(40, 25, 1);
    for (float& v : reference.data) v = 1.0f;
    for (float& v : image.data) v = 2.0f;
    image.at(7, 3)[0] = 1001.0f;
    const ImageMetrics m = compare_images(image, reference);
    EXPECT_NEAR(m.relmse, (999 + 1e6) / 1.01 / 1000, 1e-9);  // a thousand rounded terms
    EXPECT_NEAR(m.relmse_without_worst, 1 / 1.01, 1e-12);
    EXPECT_EQ(compare_images(grey(1, 1, {2}), grey(1, 1, {1})).relmse_without_worst, 0.0);
}

TEST(Metrics, MaskFromImage) { EXPECT_EQ(mask_from_image(grey(3, 1, {0, 1, 0.4f})), (Mask{0, 1, 0})); }

}  // namespace
}  // namespace lumel
