#include "post/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "path/pooled_variance.h"

namespace lumel {
namespace {

// A flat page of w x h texels of one metre whose irradiance is a function of place plus noise of standard deviation
// `sigma`, which the page states.
struct NoisyPage {
    TexelBuffer texels;
    RadianceSums sums;
    std::vector<float> truth;

    template <class Truth>
    NoisyPage(std::uint16_t width, std::uint16_t height, float sigma, Truth&& light) {
        texels.width = width;
        texels.height = height;
        std::mt19937 random(7);
        std::normal_distribution<float> noise(0.0f, sigma);
        for (std::uint16_t y = 0; y < height; ++y)
            for (std::uint16_t x = 0; x < width; ++x) {
                texels.texel_at.push_back(static_cast<std::uint32_t>(texels.size()));
                texels.x.push_back(x);
                texels.y.push_back(y);
                texels.position.push_back({static_cast<float>(x), 0, -static_cast<float>(y)});
                texels.normal.push_back({0, 1, 0});
                texels.world_size.push_back(1.0f);
                texels.chart.push_back(0);
                truth.push_back(light(x, y));
            }
        sums.resize(texels.size());
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums.count[i] = sums.open[i] = 64;
            sums.variance[i] = Vec3{1, 1, 1} * (sigma * sigma);
            LayerMoments& sky = sums.layers[i][static_cast<std::size_t>(Layer::sky)];
            sky.irradiance = Vec3{1, 1, 1} * (truth[i] + noise(random));
            sky.sh[0] = sky.irradiance * 2.0f;
        }
    }
    [[nodiscard]] float value(std::size_t i) const { return sums.layers[i][1].irradiance.x; }
    [[nodiscard]] double mean_squared_error() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < truth.size(); ++i) sum += std::pow(value(i) - truth[i], 2);
        return sum / static_cast<double>(truth.size());
    }
    [[nodiscard]] double mean() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < truth.size(); ++i) sum += static_cast<double>(value(i));
        return sum / static_cast<double>(truth.size());
    }
};

Status run(NoisyPage& page, unsigned threads = 1) {
    Context context(threads);
    return denoise(page.texels, {}, page.sums, context);
}

TEST(Denoise, LayersThatAreLeftOutHaveNoSayInWhatIsAlike) {
    // The sky is even but for noise. The direct light, which is left out, differs by far more from texel to texel than
    // the noise that is stated would explain.
    NoisyPage page(64, 64, 0.1f, [](int, int) { return 1.0f; });
    for (std::size_t i = 0; i < page.sums.size(); ++i)
        page.sums.layers[i][static_cast<std::size_t>(Layer::direct)].irradiance =
            Vec3{1, 1, 1} * static_cast<float>((i * 7919) % 101);
    const double before = page.mean_squared_error();
    Context context(1);
    DenoiseOptions options;
    options.included[static_cast<std::size_t>(Layer::direct)] = false;
    ASSERT_TRUE(denoise(page.texels, options, page.sums, context).ok());
    EXPECT_LT(page.mean_squared_error(), before / 20);  // as of even light
}

TEST(Denoise, TakesMostOfTheNoiseFromEvenLight) {
    NoisyPage page(64, 64, 0.1f, [](int, int) { return 1.0f; });
    const double before = page.mean_squared_error();
    ASSERT_TRUE(run(page).ok());
    // 225 texels of equal weight would divide it by 225; weights that follow the noise leave a share of that.
    EXPECT_LT(page.mean_squared_error(), before / 20);
}

// Light that few samples find: each texel has two halves of 32 samples, of which one in `rarity` brings 64 times
// `flash`, so that it shows as `flash` in the texel; the rest is even. The variance is what the bake would state.
NoisyPage page_of_rare_light(double rarity, float even, float flash) {
    NoisyPage page(128, 128, 0.0f, [&](int, int) { return even + 64.0f * flash / static_cast<float>(rarity); });
    std::mt19937 random(11);
    std::binomial_distribution<int> hits(32, 1.0 / rarity);
    for (std::size_t i = 0; i < page.sums.size(); ++i) {
        const auto a = static_cast<float>(hits(random)), b = static_cast<float>(hits(random));
        const float share = (a + b) / 64.0f;
        page.sums.layers[i][1].irradiance = Vec3{1, 1, 1} * (even + flash * (a + b));
        page.sums.half_difference[i] = Vec3{1, 1, 1} * (2.0f * flash * (a - b));
        page.sums.variance[i] = Vec3{1, 1, 1} * (64.0f * 64.0f * flash * flash * share * (1.0f - share) / 63.0f);
    }
    Context context(1);
    EXPECT_TRUE(pool_variance(page.texels, page.sums, context).ok());
    return page;
}

// Mostly dark: of 64 samples each, some half, a fifth, one in 20 and one in 50 texels have met the light.
TEST(Denoise, TakesMostOfTheNoiseFromRareLightAndKeepsItsMean) {
    for (const double rarity : {100.0, 320.0, 1280.0, 3200.0}) {
        NoisyPage page = page_of_rare_light(rarity, 0.1f, 0.1f);
        const double before = page.mean_squared_error(), mean = page.mean();
        ASSERT_TRUE(run(page).ok());
        EXPECT_LT(page.mean_squared_error(), before / (5 * 5)) << rarity;
        EXPECT_NEAR(page.mean(), mean, 0.015 * mean) << rarity;
    }
}

TEST(Denoise, KeepsAnEdgeThatIsNoNoise) {
    NoisyPage page(64, 64, 0.05f, [](int x, int) { return x < 32 ? 0.2f : 1.0f; });
    const double before = page.mean_squared_error();
    ASSERT_TRUE(run(page).ok());
    EXPECT_LT(page.mean_squared_error(), before / 10);
}

TEST(Denoise, DoesNotMixAcrossAFoldOrAGap) {
    // Left: floor. Middle: wall. Right: floor far away. Each of its own light, all within noise of each other.
    NoisyPage page(24, 8, 0.5f, [](int x, int) { return x < 8 ? 1.0f : x < 16 ? 1.1f : 1.2f; });
    for (std::size_t i = 0; i < page.texels.size(); ++i) {
        const int x = page.texels.x[i];
        for (LayerMoments& layer : page.sums.layers[i]) layer = {};
        page.sums.layers[i][0].irradiance = x < 8 ? Vec3{1, 0, 0} : x < 16 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
        if (x >= 8 && x < 16) page.texels.normal[i] = {1, 0, 0};
        if (x >= 16) page.texels.position[i].x += 1000.0f;
    }
    ASSERT_TRUE(run(page).ok());
    for (std::size_t i = 0; i < page.texels.size(); ++i) {
        const int x = page.texels.x[i];
        const Vec3 expected = x < 8 ? Vec3{1, 0, 0} : x < 16 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
        EXPECT_LT(length(page.sums.layers[i][0].irradiance - expected), 1e-5f) << x;
    }
}

// Left and right differ in `part(page, i)` alone; their light is within noise of each other and must not mix.
template <class Part>
void expect_parted(Part&& part) {
    NoisyPage page(16, 8, 0.5f, [](int, int) { return 1.0f; });
    const auto expected = [&](std::size_t i) { return page.texels.x[i] < 8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}; };
    for (std::size_t i = 0; i < page.texels.size(); ++i) {
        for (LayerMoments& layer : page.sums.layers[i]) layer = {};
        page.sums.layers[i][0].irradiance = expected(i);
        if (page.texels.x[i] >= 8) part(page, i);
    }
    ASSERT_TRUE(run(page).ok());
    for (std::size_t i = 0; i < page.texels.size(); ++i)
        EXPECT_LT(length(page.sums.layers[i][0].irradiance - expected(i)), 1e-5f) << page.texels.x[i];
}

// A step less high than a texel is wide: normals and distances (1.25 texels at most) say nothing.
TEST(Denoise, DoesNotMixParallelPlanes) {
    expect_parted([](NoisyPage& page, std::size_t i) { page.texels.position[i].y += 0.75f; });
}

TEST(Denoise, DoesNotMixChartsOfOnePlane) {
    expect_parted([](NoisyPage& page, std::size_t i) { page.texels.chart[i] = 1; });
}

// Light far below the page's mean is light all the same: a lamp elsewhere must not blur a dim room.
TEST(Denoise, KeepsDimEdgesBesideBrightLight) {
    NoisyPage page(64, 16, 0.0f, [](int x, int) { return x < 32 ? 1000.0f : x < 48 ? 1.0f : 2.0f; });
    ASSERT_TRUE(run(page).ok());
    EXPECT_LT(page.mean_squared_error(), 1e-6);  // noiseless: nothing may move but by rounding, 6e-5 of 1000
}

TEST(Denoise, WeighsAllCoefficientsAlikeAndLeavesInvalidTexelsAlone) {
    NoisyPage page(32, 32, 0.1f, [](int, int) { return 1.0f; });
    page.sums.open[100] = 3;
    page.sums.layers[100][1].irradiance = {50, 50, 50};
    ASSERT_TRUE(run(page).ok());
    EXPECT_EQ(page.value(100), 50.0f);
    for (std::size_t i = 0; i < page.sums.size(); ++i) {
        if (i == 100) continue;
        EXPECT_LT(page.value(i), 2.0f) << "light of an invalid texel";
        EXPECT_NEAR(page.sums.layers[i][1].sh[0].x, 2.0f * page.value(i), 1e-5f);
    }
}

TEST(ThreadDenoise, SameBitsForAnyNumber) {
    NoisyPage one(50, 70, 0.2f, [](int x, int y) { return 1.0f + 0.01f * static_cast<float>(x * y % 7); });
    NoisyPage four = one;
    ASSERT_TRUE(run(one, 1).ok() && run(four, 4).ok());
    for (std::size_t i = 0; i < one.sums.size(); ++i) ASSERT_EQ(one.value(i), four.value(i));
}

}  // namespace
}  // namespace lumel
