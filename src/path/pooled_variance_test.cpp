#include "path/pooled_variance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/charted_scene.h"

namespace lumel {
namespace {

// A flat page whose left half is one chart and right half another, each with noise of its own. Samples are stated to
// scatter 25 times as much as their means do.
struct NoisyPage {
    static constexpr std::uint16_t kEdge = 64;
    static constexpr float kOverstated = 25.0f;

    TexelBuffer texels;
    RadianceSums sums;
    std::vector<float> error;  // of each texel's mean

    NoisyPage(float left, float right) {
        texels.width = texels.height = kEdge;
        sums.resize(std::size_t{kEdge} * kEdge);
        std::mt19937 random(5);
        std::normal_distribution<float> normal;
        for (std::uint16_t y = 0; y < kEdge; ++y)
            for (std::uint16_t x = 0; x < kEdge; ++x) {
                const std::size_t i = texels.texel_at.size();
                texels.texel_at.push_back(static_cast<std::uint32_t>(i));
                texels.x.push_back(x);
                texels.y.push_back(y);
                texels.normal.push_back({0, 1, 0});
                texels.chart.push_back(x < kEdge / 2 ? 0 : 1);
                const float sigma = x < kEdge / 2 ? left : right;  // of the mean, so of each half sqrt(2) as much
                const float a = normal(random) * sigma * std::sqrt(2.0f), b = normal(random) * sigma * std::sqrt(2.0f);
                error.push_back(0.5f * (a + b));
                sums.half_difference[i] = Vec3{1, 1, 1} * (a - b);
                sums.variance[i] = Vec3{1, 1, 1} * (kOverstated * sigma * sigma);
                sums.count[i] = sums.open[i] = 64;
            }
    }
    // Share of a half's texels whose 95 % interval contains the truth.
    [[nodiscard]] double coverage(bool right) const {
        double covered = 0.0;
        for (std::size_t i = 0; i < error.size(); ++i)
            if ((texels.chart[i] == 1) == right)
                covered += std::fabs(error[i]) <= 1.96f * std::sqrt(sums.variance[i].y);
        return 2.0 * covered / static_cast<double>(error.size());
    }
};

TEST(PooledVariance, ItsIntervalsContainTheTruthInEachChart) {
    NoisyPage page(0.1f, 0.001f);
    Context context(1);
    EXPECT_EQ(page.coverage(false), 1.0);  // as stated, all too wide
    ASSERT_TRUE(pool_variance(page.texels, page.sums, context).ok());
    // 2048 texels each: a deviation of 0.5 %, somewhat more as neighbours share their pools.
    EXPECT_NEAR(page.coverage(false), 0.95, 0.015);
    EXPECT_NEAR(page.coverage(true), 0.95, 0.015);
}

TEST(PooledVariance, LeavesTexelsOfOneSampleAndInvalidOnesOut) {
    NoisyPage page(0.1f, 0.1f);
    const std::size_t single = 10 * NoisyPage::kEdge + 10, invalid = 10 * NoisyPage::kEdge + 12;
    page.sums.count[single] = page.sums.open[single] = 1;
    page.sums.open[invalid] = 3;
    for (const std::size_t i : {single, invalid}) {
        page.sums.half_difference[i] = {1e6f, 1e6f, 1e6f};
        page.sums.variance[i] = {7, 7, 7};
    }
    Context context(1);
    ASSERT_TRUE(pool_variance(page.texels, page.sums, context).ok());
    EXPECT_EQ(page.sums.variance[single], (Vec3{7, 7, 7}));
    EXPECT_EQ(page.sums.variance[invalid], (Vec3{7, 7, 7}));
    EXPECT_LT(page.sums.variance[single + 1].x, 0.1f);
}

TEST(ThreadPooledVariance, SameBitsForAnyNumber) {
    NoisyPage one(0.1f, 0.2f), eight(0.1f, 0.2f);
    Context alone(1), together(8);
    ASSERT_TRUE(pool_variance(one.texels, one.sums, alone).ok());
    ASSERT_TRUE(pool_variance(eight.texels, eight.sums, together).ok());
    EXPECT_EQ(one.sums.variance, eight.sums.variance);
}

// Sun with a size, sky, lamp, point light, bounces: 128 samples against 2048 of other point sets, whose own variance is
// a sixteenth at most.
TEST(PooledVariance, HoldsInARoom) {
    Context context(2);
    const test::ChartedScene room(test::room(), 6, context);
    const auto gather = [&](std::uint32_t samples, std::uint64_t seed) {
        PathOptions path;
        path.samples = samples;
        path.seed = seed;
        path.bounces = 4;
        return room.gather(path);
    };
    RadianceSums sums = gather(128, 1);
    const RadianceSums truth = gather(2048, 2);
    const double stated = [&] {
        double sum = 0.0;
        for (const Vec3& v : sums.variance) sum += static_cast<double>(v.y);
        return sum;
    }();
    ASSERT_TRUE(pool_variance(room.texels, sums, context).ok());
    double covered = 0.0, valid = 0.0, pooled = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        pooled += static_cast<double>(sums.variance[i].y);
        if (!sums.valid(i) || !truth.valid(i)) continue;
        const float difference = test::total_irradiance(sums, i).y - test::total_irradiance(truth, i).y;
        covered += std::fabs(difference) <= 1.96f * std::sqrt(17.0f / 16.0f * sums.variance[i].y);
        valid += 1.0;
    }
    ASSERT_GT(valid, 300.0);
    EXPECT_LT(pooled, 0.7 * stated);  // evenly spread samples are better than independent ones
    // 400 texels: a deviation of 1.1 %; neighbours share their pools.
    EXPECT_NEAR(covered / valid, 0.95, 0.035);
}

}  // namespace
}  // namespace lumel
