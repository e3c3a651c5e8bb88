#include "score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "image/metrics.h"
#include "math/normal_quantile.h"
#include "methods.h"
#include "support/statistics.h"
#include "support/temporary_folder.h"
#include "support/traced_scene.h"

namespace lumel::bench {
namespace {

// A page of 32 x 32 texels, all covered, with a reference and a bake of random light.
struct RandomPage {
    explicit RandomPage(float error) {
        texels.width = texels.height = 32;
        sums.resize(kTexels);
        test::Random random(3);
        const auto draw = [&](float scale) {
            const Vec2 u = random.pair();
            return Vec3{u.x, u.y, random.unit()} * scale;
        };
        for (std::uint32_t i = 0; i < kTexels; ++i) {
            texels.x.push_back(static_cast<std::uint16_t>(i % 32));
            texels.y.push_back(static_cast<std::uint16_t>(i / 32));
            const Vec3 truth = Vec3{1, 1, 1} + draw(5.0f);
            for (ReferenceHalf* half : {&a, &b}) {
                half->light.push_back({truth + draw(0.1f), {truth, draw(1.0f), draw(1.0f), draw(1.0f)}});
                half->valid.push_back(1);
            }
            sums.layers[i][0].irradiance = truth * 0.25f;
            sums.layers[i][2].irradiance = truth * 0.75f + draw(error);
            sums.layers[i][1].sh[0] = truth;
            sums.open[i] = sums.count[i] = 1;
        }
    }
    static constexpr std::size_t kTexels = 32 * 32;
    [[nodiscard]] Score scored() const { return score(sums, a, b, texels, {0, kTexels}); }

    TexelBuffer texels;
    RadianceSums sums;
    ReferenceHalf a, b;
};

Image picture(const std::vector<TexelLight>& light) {
    Image out(32, 32, 3);
    for (std::size_t i = 0; i < light.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) out.data[3 * i + c] = light[i].irradiance[c];
    return out;
}

TEST(Score, OfIrradianceIsTheProductOfTheErrors) {
    const RandomPage page(0.7f);
    std::vector<TexelLight> light;
    for (std::size_t i = 0; i < RandomPage::kTexels; ++i) light.push_back(light_of(page.sums, i));
    const double expected = cross_relmse(picture(light), picture(page.a.light), picture(page.b.light));
    EXPECT_NEAR(page.scored().relmse, expected, 1e-6 * expected);  // sums of floats and of doubles
    EXPECT_GT(expected, 1e-3);
    EXPECT_EQ(page.scored().texels, RandomPage::kTexels);
}

// The halves differ from the truth by independent noise: a bake that is the truth scores nothing, though it differs
// from their mean by as much as they do.
TEST(Score, DoesNotCountTheNoiseOfTheReference) {
    RandomPage page(0.0f);
    test::Random random(8);
    for (ReferenceHalf* half : {&page.a, &page.b})
        for (std::size_t i = 0; i < RandomPage::kTexels; ++i)
            half->light[i].irradiance =
                light_of(page.sums, i).irradiance * (1.0f + 0.4f * (random.unit() - 0.5f));  // variance 0.16/12
    const Score s = page.scored();
    EXPECT_NEAR(s.reference_relmse, 0.16 / 12 / 2, 0.1 * 0.16 / 12 / 2);
    EXPECT_LT(std::fabs(s.relmse), 0.1 * s.reference_relmse);
}

TEST(Score, OfBothBandsIsThatOfTheirVector) {
    RandomPage page(0.0f);
    for (std::size_t i = 0; i < RandomPage::kTexels; ++i) {
        // Truth (3, 0, 0, 4) in every channel; the bake is off by (0, 0.5, 0, 0): 0.25 / (25 + 0.01 25).
        for (ReferenceHalf* half : {&page.a, &page.b})
            half->light[i].sh = {Vec3{3, 3, 3}, Vec3{}, Vec3{}, Vec3{4, 4, 4}};
        for (LayerMoments& layer : page.sums.layers[i]) layer.sh = {};
        page.sums.layers[i][2].sh[0] = {3, 3, 3};
        page.sums.layers[i][1].sh[1] = {0.5f, 0.5f, 0.5f};
        page.sums.layers[i][0].sh[3] = {4, 4, 4};
        page.sums.layers[i][0].sh[7] = {9, 9, 9};  // of the second band, which is not scored
    }
    EXPECT_NEAR(page.scored().relmse_sh, 0.25 / 25.25, 1e-6);
}

TEST(Score, LeavesOutTheWorstTexelsWhereItSays) {
    RandomPage page(0.7f);
    const Score before = page.scored();
    page.sums.layers[5][0].irradiance = {1000, 1000, 1000};  // one of 1024
    const Score after = page.scored();
    EXPECT_GT(after.relmse, 100.0 * before.relmse);
    EXPECT_NEAR(after.relmse_without_worst, before.relmse_without_worst, 0.02 * before.relmse);
    page.sums.open[5] = 0;  // invalid
    EXPECT_EQ(page.scored().texels, RandomPage::kTexels - 1);
    EXPECT_LT(page.scored().relmse, 2.0 * before.relmse);
}

TEST(Score, BiasIsThatOfBlockMeans) {
    RandomPage page(0.0f);
    for (std::size_t i = 0; i < RandomPage::kTexels; ++i) {
        // One of the four blocks is 8 % too dark, the others are 2 % too bright; within a block the texels alternate.
        const bool dark = page.texels.x[i] < 16 && page.texels.y[i] < 16;
        const float sign = (page.texels.x[i] & 1) ? 1.0f : -1.0f;
        page.a.light[i].irradiance = page.b.light[i].irradiance = {2, 2, 2};
        for (LayerMoments& layer : page.sums.layers[i]) layer.irradiance = {};
        page.sums.layers[i][1].irradiance = Vec3{2, 2, 2} * (dark ? 0.92f : 1.02f) + Vec3{1, 1, 1} * (sign * 0.5f);
        page.sums.variance[i] = {0.01f, 0.01f, 0.01f};
    }
    const Score s = page.scored();
    EXPECT_NEAR(s.bias, (3 * 0.02 - 0.08) / 4, 1e-6);
    // 95th percentile of 0.02, 0.02, 0.02, 0.08, linear between the last two; 1.01: the floor.
    EXPECT_NEAR(s.block_bias, (0.02 + 0.85 * 0.06) / 1.01, 1e-6);
    // 256 texels with a deviation of 3 x 0.1 in the sum of channels, of 6: 1.96 deviations of the mean.
    EXPECT_NEAR(s.block_noise, 1.96 * 0.3 / 16 / (6 * 1.01), 1e-4);
}

// 64 x 64 texels, row by row brighter from 1 to 2, whose channels err independently by normal noise: the bake's
// deviation is `noise` of the brightness, that of each half of the reference `reference_noise`. The bake states its
// variance times `stated` of the row.
class GaussianPage {
public:
    static constexpr std::uint32_t kEdge = 64, kTexels = kEdge * kEdge;

    template <class Stated>
    GaussianPage(float noise, float reference_noise, const Stated& stated) {
        texels_.width = texels_.height = kEdge;
        sums_.resize(kTexels);
        for (std::uint32_t i = 0; i < kTexels; ++i) {
            const std::uint32_t row = i / kEdge;
            texels_.x.push_back(static_cast<std::uint16_t>(i % kEdge));
            texels_.y.push_back(static_cast<std::uint16_t>(row));
            const float truth = 1.0f + static_cast<float>(i) / kTexels;
            sums_.layers[i][1].irradiance = erring(truth, noise);
            sums_.variance[i] = Vec3{1, 1, 1} * (stated(row) * truth * truth * noise * noise);
            sums_.open[i] = sums_.count[i] = 1;
            for (ReferenceHalf* half : {&a_, &b_}) {
                half->light.push_back({erring(truth, reference_noise), {}});
                half->valid.push_back(1);
            }
        }
    }
    void brighten(float factor) {
        for (auto& layers : sums_.layers) layers[1].irradiance *= factor;
    }
    [[nodiscard]] Score scored() const { return score(sums_, a_, b_, texels_, {0, kTexels}); }

private:
    Vec3 erring(float truth, float noise) {
        const auto normal = [&] {
            return static_cast<float>(normal_quantile(static_cast<double>(random_.unit()) + 0x1p-25));
        };
        const float x = normal(), y = normal(), z = normal();
        return Vec3{1, 1, 1} * truth + Vec3{x, y, z} * (truth * noise);
    }

    test::Random random_{11};
    TexelBuffer texels_;
    RadianceSums sums_;
    ReferenceHalf a_, b_;
};

// A share that `draws` of probability p show, within four deviations.
void expect_share(double share, double p, double draws) {
    EXPECT_NEAR(share, p, 4.0 * std::sqrt(p * (1.0 - p) / draws));
}

// The share of normal draws within 1.96 deviations where these are stated `stated` times too large.
double share_within(double stated) { return 2.0 * normal_cdf(1.96 * stated) - 1.0; }

TEST(Score, CoverageIsTheShareOfNormalNoiseWithinItsInterval) {
    constexpr double kDraws = 3.0 * GaussianPage::kTexels;
    const auto coverage = [](float stated_variance) {
        return GaussianPage(0.1f, 0.0f, [&](std::uint32_t) { return stated_variance; }).scored().coverage;
    };
    expect_share(coverage(1.0f), 0.95, kDraws);
    expect_share(coverage(0.5f), share_within(std::sqrt(0.5)), kDraws);  // 0.834
    expect_share(coverage(0.25f), share_within(0.5), kDraws);            // 0.673
    EXPECT_EQ(coverage(100.0f), 1.0);
}

// Stated four times too small in the darkest rows and nine times too large in the brightest: the deciles tell, which
// are of 6.4 rows.
TEST(Score, CoverageOfDecilesIsByBrightness) {
    const Score s = GaussianPage(0.1f, 0.0f, [](std::uint32_t row) {
                        return row < 7 ? 0.25f : row < 57 ? 1.0f : 9.0f;
                    }).scored();
    constexpr double kDraws = 3.0 * GaussianPage::kTexels / 10.0;
    expect_share(s.lowest_coverage, share_within(0.5), kDraws);
    EXPECT_EQ(s.highest_coverage, 1.0);  // 3.7e-9 beyond 5.88 deviations
    const double expected = (7 * share_within(0.5) + 50 * 0.95 + 7 * 1.0) / 64;
    expect_share(s.coverage, expected, 10.0 * kDraws);
}

// The reference's own variance widens the interval, by its two halves: the difference of bake and reference is normal,
// its estimated variance v_x + v_a chi-squared of one degree, where v_a = v_x / 2 is true.
TEST(Score, CoverageAllowsForTheNoiseOfTheReference) {
    const double with = GaussianPage(0.1f, 0.1f, [](std::uint32_t) { return 1.0f; }).scored().coverage;
    double expected = 0.0;  // over the normal quantiles g of (a - b) / sqrt(2)
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double g = normal_quantile((i + 0.5) / kSteps);
        expected += share_within(std::sqrt((1.0 + 0.5 * g * g) / 1.5)) / kSteps;
    }
    EXPECT_GT(expected, 0.92);
    expect_share(with, expected, 3.0 * GaussianPage::kTexels);
}

// Noise of 5 % in the bake and in each half: what is scored is the bake's variance alone. A product of errors has a
// deviation of sqrt(5) v, so the mean of 12288 has one of 2 %; the floor adds a hundredth of the mean's square to
// squares between 1 and 4.
TEST(Score, OfPureNoiseIsItsVarianceWhateverTheReferences) {
    constexpr double kVariance = 0.05 * 0.05;
    double share = 0.0;  // of the square in what it is divided by
    for (std::uint32_t i = 0; i < GaussianPage::kTexels; ++i) {
        const double truth = 1.0 + static_cast<double>(i) / GaussianPage::kTexels;
        share += truth * truth / (truth * truth + 0.01 * 1.5 * 1.5) / GaussianPage::kTexels;
    }
    for (const float reference_noise : {0.0f, 0.05f}) {
        const Score s = GaussianPage(0.05f, reference_noise, [](std::uint32_t) { return 1.0f; }).scored();
        EXPECT_NEAR(s.relmse, kVariance * share, 4 * 0.02 * kVariance) << reference_noise;
        EXPECT_NEAR(s.reference_relmse, reference_noise > 0.0f ? 0.5 * kVariance * share : 0.0, 0.05 * kVariance);
    }
}

// 2 % too bright everywhere is a bias of 2 % in all and in each block (less the hundredth of the mean that is
// added to what it is divided by: 0.8 to 1.4 % of the light of a block).
TEST(Score, AConstantShiftIsTheBiasOfEveryBlock) {
    GaussianPage exact(0.0f, 0.0f, [](std::uint32_t) { return 1.0f; });
    exact.brighten(1.02f);
    Score s = exact.scored();
    EXPECT_NEAR(s.bias, 0.02, 1e-6);
    EXPECT_NEAR(s.block_bias, 0.02, 0.02 * 0.014);
    EXPECT_EQ(s.coverage, 0.0);
    // With noise of 5 %: 768 values in a block, so 0.18 % of noise in each of 16, and the largest of them is two
    // deviations up.
    GaussianPage noisy(0.05f, 0.0f, [](std::uint32_t) { return 1.0f; });
    noisy.brighten(1.02f);
    s = noisy.scored();
    EXPECT_NEAR(s.bias, 0.02, 4 * 0.0018 / 4);
    EXPECT_NEAR(s.block_bias, 0.02 + 1.8 * 0.0018, 3 * 0.0018);
}

TEST(Score, JointQuantileOfNormalsIsTheirs) {
    EXPECT_NEAR(joint_p95(std::vector<double>{2.0, 2.0, 2.0}), 1.959964 * 2.0, 1e-4);
    // Half of the draws are zero: of the others one in ten is beyond.
    EXPECT_NEAR(joint_p95(std::vector<double>{0.0, 1.0}), 1.644854, 1e-4);
    EXPECT_EQ(joint_p95({}), 0.0);
}

class Reference : public testing::Test {
protected:
    ReferenceHalf half(std::uint32_t which, std::uint32_t samples) {
        return reference_half(*bench, bench->middle_texels(40), which, {folder.path(), 5.0, samples}, context);
    }
    static bool same(const ReferenceHalf& a, const ReferenceHalf& b) {
        return std::ranges::equal(a.light, b.light, [](const TexelLight& x, const TexelLight& y) {
            return x.irradiance == y.irradiance && x.sh == y.sh;
        });
    }

    static ChartOptions coarse() {
        ChartOptions options;
        options.texels_per_metre = 2.0;
        return options;
    }

    Context context{1};
    ChartOptions charts = coarse();
    std::unique_ptr<BenchScene> bench = std::make_unique<BenchScene>("room", test::room(), charts, context);
    test::TemporaryFolder folder;
};

TEST_F(Reference, IsContinuedToTheSameLightAsInOneRun) {
    const ReferenceHalf at_once = half(0, 768);
    EXPECT_EQ(at_once.samples, 768u);
    std::filesystem::remove_all(folder.path());
    const ReferenceHalf some = half(0, 256);
    EXPECT_EQ(some.samples, 256u);
    EXPECT_FALSE(same(some, at_once));
    EXPECT_TRUE(same(half(0, 768), at_once));
    EXPECT_TRUE(same(half(0, 256), at_once)) << "what is there is used";
    EXPECT_FALSE(same(half(1, 768), at_once)) << "the halves are one";
}

TEST_F(Reference, DamagedFilesAreMadeAnewAndOtherScenesHaveTheirOwn) {
    const ReferenceHalf whole = half(0, 256);
    ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
    const auto file = std::filesystem::directory_iterator(folder.path())->path();
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
    EXPECT_TRUE(same(half(0, 256), whole));
    EXPECT_EQ(std::filesystem::file_size(file) % 8, 0u) << "still damaged";
    Scene brighter = test::room();
    brighter.sky.color = {9, 9, 9};
    bench = std::make_unique<BenchScene>("room", std::move(brighter), charts, context);
    const ReferenceHalf other = half(0, 256);
    EXPECT_FALSE(same(other, whole));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

// Set to Lumel's choices the peer has Lumel's error: what is left of it carries no handicap.
TEST_F(Reference, ThePeerIsAFairOne) {
    const TexelRange all = bench->middle_texels(0);
    const ReferenceOptions options{folder.path(), 5.0, 2048};
    const ReferenceHalf a = reference_half(*bench, all, 0, options, context);
    const ReferenceHalf b = reference_half(*bench, all, 1, options, context);
    const auto error_of = [&](std::string_view method) {
        double sum = 0.0;
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            PathOptions path;
            path.samples = 64;
            path.seed = seed;
            sum += score(find_method(method)->gather({*bench, path, all, context}), a, b, bench->texels, all).relmse;
        }
        return sum / 8.0;
    };
    for (const auto& [peer, lumel] : {std::pair{"flux-as-power", "power"}, {"flux-as-tree", "tree"}}) {
        const double ratio = error_of(peer) / error_of(lumel);
        // Some 300 texels, 8 runs: the ratio's own noise is below 0.05.
        EXPECT_GT(ratio, 1.0 / 1.2) << peer;
        EXPECT_LT(ratio, 1.2) << peer;
    }
}

}  // namespace
}  // namespace lumel::bench
