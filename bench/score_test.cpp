#include "score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "image/metrics.h"
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
            sums.count[i] = sums.traced[i] = 1;
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
    page.sums.count[5] = 0;  // invalid
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
