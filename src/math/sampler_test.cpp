// What a sampler must be: stratified within a texel (nets), fair over texels (every number uniform), and without memory
// between pairs of dimensions.
#include "math/sampler.h"

#include <gtest/gtest.h>

#include <set>

#include "support/statistics.h"

namespace lumel {
namespace {

// The points first..first+2^m of one pair form a (0,m,2)-net: every elementary interval of area 2^-m holds one.
::testing::AssertionResult is_net(std::uint32_t key, std::uint32_t pair, std::uint32_t first, std::uint32_t m) {
    const std::uint32_t count = 1u << m;
    for (std::uint32_t a = 0; a <= m; ++a) {
        std::vector<int> cells(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec2 p = Sampler(key, first + i).pair(pair);
            const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(1u << a));
            const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(1u << (m - a)));
            if (++cells[(x << (m - a)) + y] > 1)
                return ::testing::AssertionFailure()
                       << "key " << key << " pair " << pair << " first " << first << ": 2^" << m << " points, "
                       << (1u << a) << " columns: cell hit twice";
        }
    }
    return ::testing::AssertionSuccess();
}

TEST(Sampler, EveryPowerOfTwoPrefixIsANet) {
    for (std::uint32_t id = 0; id < 6; ++id)
        for (const std::uint32_t pair : {0u, 1u, 2u, 7u, 500u})
            for (std::uint32_t m = 0; m <= 10; ++m) EXPECT_TRUE(is_net(sampler_key(1, id), pair, 0, m));
}

TEST(Sampler, EveryAlignedBlockIsANet) {
    for (std::uint32_t id = 0; id < 4; ++id)
        for (const std::uint32_t m : {2u, 6u, 8u})
            for (const std::uint32_t block : {1u, 2u, 5u, 1000u})
                EXPECT_TRUE(is_net(sampler_key(9, id), 3, block << m, m));
}

TEST(Sampler, NumbersLieInTheHalfOpenUnitInterval) {
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Vec2 p = Sampler(sampler_key(3, i / 100), i).pair(i % 13);
        ASSERT_GE(p.x, 0.0f);
        ASSERT_LT(p.x, 1.0f);
        ASSERT_GE(p.y, 0.0f);
        ASSERT_LT(p.y, 1.0f);
    }
    EXPECT_EQ(unit_float(0xffffffffu), 0x1.fffffep-1f);
}

// Over texels each sample must be uniform in the square on its own: the estimate of a texel is then unbiased.
TEST(Sampler, EverySampleIsUniformOverTexels) {
    constexpr std::size_t kGrid = 16;
    constexpr std::uint32_t kTexels = 51200;
    const std::vector<std::uint32_t> indices{0, 1, 2, 3, 8, 255, 4096}, pairs{0, 1, 2, 5, 64};
    const double significance = test::sidak(1e-4, indices.size() * pairs.size());
    for (const std::uint32_t index : indices)
        for (const std::uint32_t pair : pairs) {
            std::vector<double> observed(kGrid * kGrid), expected(kGrid * kGrid, double(kTexels) / (kGrid * kGrid));
            for (std::uint32_t texel = 0; texel < kTexels; ++texel) {
                const Vec2 p = Sampler(sampler_key(1, texel), index).pair(pair);
                observed[static_cast<std::size_t>(p.x * kGrid) * kGrid + static_cast<std::size_t>(p.y * kGrid)] += 1;
            }
            EXPECT_TRUE(test::counts_agree(observed, expected, significance)) << "index " << index << " pair " << pair;
        }
}

// Two pairs of one sample, and two samples of one pair that a net does not tie together, must be independent.
TEST(Sampler, PairsAreJointlyUniformOverTexels) {
    constexpr std::size_t kGrid = 16;
    constexpr std::uint32_t kTexels = 51200;
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs{{0, 1}, {0, 2}, {1, 2}, {1, 4}, {3, 7}, {0, 32}};
    const double significance = test::sidak(1e-4, 4 * pairs.size());
    for (const auto& pair : pairs)
        for (int axes = 0; axes < 4; ++axes) {
            std::vector<double> observed(kGrid * kGrid), expected(kGrid * kGrid, double(kTexels) / (kGrid * kGrid));
            for (std::uint32_t texel = 0; texel < kTexels; ++texel) {
                const Sampler sampler(sampler_key(1, texel), 5);
                const Vec2 p = sampler.pair(pair.first), q = sampler.pair(pair.second);
                const float a = axes & 1 ? p.y : p.x, b = axes & 2 ? q.y : q.x;
                observed[static_cast<std::size_t>(a * kGrid) * kGrid + static_cast<std::size_t>(b * kGrid)] += 1;
            }
            EXPECT_TRUE(test::counts_agree(observed, expected, significance))
                << "pairs " << pair.first << " and " << pair.second << " axes " << axes;
        }
}

// Within one texel: the products of two pairs' numbers average to 1/4 over texels, as an estimate of an integral over
// four dimensions needs, and not with more noise than independent numbers would have (7/144 per sample): two pairs
// whose samples came in the same order would have five times as much.
TEST(Sampler, PairsAreUncorrelatedWithinATexel) {
    constexpr std::uint32_t kSamples = 64, kTexels = 20000;
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs{{0, 1}, {0, 2}, {1, 2}, {2, 3}, {4, 9}};
    for (const auto& pair : pairs) {
        test::Moments xx, xy;
        for (std::uint32_t texel = 0; texel < kTexels; ++texel) {
            double sum_xx = 0, sum_xy = 0;
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                const Sampler sampler(sampler_key(1, texel), i);
                const Vec2 p = sampler.pair(pair.first), q = sampler.pair(pair.second);
                sum_xx += double{p.x} * q.x;
                sum_xy += double{p.x} * q.y;
            }
            xx.add(sum_xx / kSamples);
            xy.add(sum_xy / kSamples);
        }
        for (const test::Moments& moments : {xx, xy}) {
            EXPECT_TRUE(test::mean_agrees(moments, 0.25, 1e-4, 2 * pairs.size())) << pair.first << " " << pair.second;
            // The variance over 20,000 texels is known to 1 %.
            EXPECT_LT(moments.variance(), 1.05 * 7.0 / 144 / kSamples) << pair.first << " " << pair.second;
        }
    }
}

TEST(Sampler, AnIntegralConvergesFasterThanRandomNumbersWould) {
    // Variance of the mean of x y over 256 points: 7/144/256 = 1.9e-4 for independent ones; nets leave far less.
    test::Moments means;
    for (std::uint32_t texel = 0; texel < 500; ++texel) {
        double sum = 0;
        for (std::uint32_t i = 0; i < 256; ++i) {
            const Vec2 p = Sampler(sampler_key(1, texel), i).pair(0);
            sum += double{p.x} * p.y;
        }
        means.add(sum / 256);
    }
    EXPECT_TRUE(test::mean_agrees(means, 0.25, 1e-4));
    EXPECT_LT(means.variance(), 7.0 / 144 / 256 / 100);  // measured about 1/3000 of it
}

TEST(SamplerKey, DiffersForTexelsAndSeeds) {
    // 2^17 keys among 2^32: 2 collisions expected by the birthday rule; 20 would be a broken hash.
    std::set<std::uint32_t> keys;
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
        for (std::uint64_t id = 0; id < 65536; ++id) keys.insert(sampler_key(seed, (id << 20) + id));
    EXPECT_GT(keys.size(), 131072u - 20u);
}

TEST(SamplerHash, BitsAreFairAndDifferBySalt) {
    test::Moments means;
    int equal = 0;
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Sampler sampler(sampler_key(1, i / 64), i % 64);
        means.add(unit_float(sampler.hash(7)));
        equal += (sampler.hash(7) & 0xff) == (sampler.hash(8) & 0xff);
    }
    EXPECT_TRUE(test::mean_agrees(means, 0.5, 1e-4));
    EXPECT_NEAR(equal, 100000 / 256.0, 4.0 * std::sqrt(100000 / 256.0));  // 4 standard deviations
}

}  // namespace
}  // namespace lumel
