#include "path/adaptive_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/charted_scene.h"

namespace lumel {
namespace {

// n texels of mean 1 whose halves differ by d, after 64 samples.
std::vector<TexelProgress> even_block(std::size_t n, double d) {
    return std::vector(n, TexelProgress{1.0, d, 64, true});
}

std::vector<std::uint32_t> wanted(const std::vector<TexelProgress>& block, double error, std::uint32_t budget) {
    std::vector<std::uint32_t> out(block.size());
    adaptive_samples(block, error, budget, out);
    return out;
}

TEST(AdaptiveSamples, FourTimesAsManyForHalfTheError) {
    // The mean of both halves errs by 0.1, one sample by 0.8.
    const auto block = even_block(64, 0.2);
    const double n = wanted(block, 0.1, 100000)[0], four = wanted(block, 0.05, 100000)[0];
    EXPECT_GT(n, 64.0) << "64 samples err by 0.1 exactly: a margin is added";
    EXPECT_LT(n, 128.0);
    EXPECT_NEAR(four / n, 4.0, 0.5);
    EXPECT_EQ(wanted(block, 0.01, 500)[0], 500u) << "the budget";
    EXPECT_EQ(wanted(block, 1.0, 500)[0], 64u) << "what it has";
}

// What one texel has seen changes what all others want, and nothing for itself.
TEST(AdaptiveSamples, ATexelHasNoSayOfItsOwn) {
    const auto calm = even_block(64, 0.2);
    auto one_bright = calm;
    one_bright[5] = {9.0, 16.0, 64, true};
    const auto before = wanted(calm, 0.1, 100000), after = wanted(one_bright, 0.1, 100000);
    EXPECT_EQ(after[5], before[5]);
    for (const std::size_t i : {0u, 4u, 63u}) EXPECT_GT(after[i], 2 * before[i]);
}

TEST(AdaptiveSamples, WithoutNeighboursTheBudgetIsSpent) {
    EXPECT_EQ(wanted(even_block(8, 0.001), 0.1, 4096), std::vector<std::uint32_t>(8, 4096));
    EXPECT_EQ(wanted(even_block(9, 0.001), 0.1, 4096), std::vector<std::uint32_t>(9, 64));
    std::vector<TexelProgress> black(64, TexelProgress{0.0, 0.0, 64, true});
    EXPECT_EQ(wanted(black, 0.1, 4096)[0], 4096u) << "nobody has seen light: nothing is known";
    auto invalid = even_block(64, 0.001);
    for (std::size_t i = 8; i < 64; ++i) invalid[i].valid = false;
    EXPECT_EQ(wanted(invalid, 0.1, 4096)[0], 4096u) << "seven others";
    EXPECT_EQ(wanted(invalid, 0.1, 4096)[60], 64u) << "eight others";
}

// A floor under a dark lid with a hole: one ray in some 300 finds the sky, which is not sampled.
Scene floor_below_a_small_hole() {
    test::SceneBuilder b;
    const auto black = b.material({0, 0, 0});
    b.object("floor", black, [](Mesh& m) { test::add_quad(m, {0, 0, 4}, {4, 0, 0}, {0, 0, -4}); });
    const auto lid = b.object("lid", black, [](Mesh& m) {
        test::add_quad(m, {-40, 2, -40}, {84, 0, 0}, {0, 0, 41.9f});
        test::add_quad(m, {-40, 2, 2.1f}, {84, 0, 0}, {0, 0, 41.9f});
        test::add_quad(m, {-40, 2, 1.9f}, {41.9f, 0, 0}, {0, 0, 0.2f});
        test::add_quad(m, {2.2f, 2, 1.9f}, {41.9f, 0, 0}, {0, 0, 0.2f});
    });
    b.scene().instances[lid].node_class = NodeClass::occluder;
    b.scene().sky.color = {1, 1, 1};
    return b.build();
}

TEST(AdaptiveSamples, RareLightIsNotLost) {
    Context context(2);
    const test::ChartedScene floor(floor_below_a_small_hole(), 8, context);
    const auto gather = [&](StopRule stop, std::uint32_t samples, std::uint64_t seed) {
        PathOptions path;
        path.bounces = 0;
        path.samples = samples;
        path.seed = seed;
        path.stop = stop;
        path.relative_error_of_mean = 0.4;
        return floor.gather(path);
    };
    struct Outcome {
        double mean = 0.0, variance = 0.0, samples = 0.0;
    };
    const auto outcome = [&](const RadianceSums& sums) {
        Outcome out;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            out.mean += static_cast<double>(test::total_irradiance(sums, i).y);
            out.variance += static_cast<double>(sums.variance[i].y);
            out.samples += sums.count[i];
        }
        out.samples /= static_cast<double>(sums.size());
        return out;
    };
    const Outcome truth = outcome(gather(StopRule::fixed, 4096, 1));
    const Outcome adaptive = outcome(gather(StopRule::error, 4096, 2)), flux = outcome(gather(StopRule::flux, 4096, 2));
    EXPECT_LT(adaptive.samples, 3500.0) << "it never stops";
    EXPECT_GT(adaptive.samples, 256.0);
    // Samples are taken as independent here, which is more than there is.
    EXPECT_LT(std::fabs(adaptive.mean - truth.mean), 4.0 * std::sqrt(adaptive.variance + truth.variance));
    EXPECT_NEAR(adaptive.mean / truth.mean, 1.0, 0.01);
    EXPECT_LT(flux.mean / truth.mean, 0.97) << "the published rule: if it were right, this scene would test nothing";
}

}  // namespace
}  // namespace lumel
