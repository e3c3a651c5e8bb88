#include "light/sky_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/sky_map.h"
#include "math/constants.h"
#include "support/sky_maps.h"
#include "support/statistics.h"

namespace lumel {
namespace {

test::Moments integral_by_sampling(const SkyMap& map, int count = 400000) {
    const SkySampler sampler(map);
    test::Random random(1);
    test::Moments moments;
    for (int i = 0; i < count; ++i) {
        const SkySampler::Sample s = sampler.sample(random.pair());
        moments.add(lookup(map, s.direction).y / s.pdf);
    }
    return moments;
}

// The integral of the bilinear lookup over the sphere, by midpoints.
double integral_by_quadrature(const SkyMap& map, int steps = 8) {
    double sum = 0;
    const int rows = static_cast<int>(map.height) * steps, columns = static_cast<int>(map.width) * steps;
    for (int y = 0; y < rows; ++y) {
        const double v = (y + 0.5) / rows;
        double row = 0;
        for (int x = 0; x < columns; ++x)
            row += lookup(map, Vec2{static_cast<float>((x + 0.5) / columns), static_cast<float>(v)}).y;
        sum += row * std::sin(v * 3.14159265358979);
    }
    return sum * 2 * 3.14159265358979 * 3.14159265358979 / (double(rows) * columns);
}

TEST(SkySampler, GivesTheIntegralOfTheLookup) {
    // One bright pixel on black tests that bleeding into neighbours is sampled; at a corner, that it wraps and clamps.
    std::vector<std::pair<const char*, SkyMap>> maps;
    maps.emplace_back("gradient", test::gradient_sky(64, 32, 1.0f, 0.8f));
    maps.emplace_back("one pixel", test::one_pixel_sky(32, 16, 7, 5, {10, 1000, 30}));
    maps.emplace_back("one pixel in the corner", test::one_pixel_sky(32, 16, 0, 0, {10, 1000, 30}));
    maps.emplace_back("one pixel in the last row", test::one_pixel_sky(32, 16, 31, 15, {10, 1000, 30}));
    maps.emplace_back("random", test::random_sky(64, 32, 3));
    for (const auto& [name, map] : maps)
        EXPECT_TRUE(test::mean_agrees(integral_by_sampling(map), integral_by_quadrature(map), 1e-4, maps.size(), 1e-4))
            << name;  // 1e-4: the quadrature's own error at the poles
}

TEST(SkySampler, SamplesFollowTheDensity) {
    for (const SkyMap& map : {test::random_sky(16, 8, 5), test::one_pixel_sky(16, 8, 3, 2, {1, 1, 1})}) {
        const SkySampler sampler(map);
        test::DirectionTest chi2;
        chi2.axis = {0, 1, 0};
        chi2.quadrature = 48;  // pixel edges run through cells
        chi2.significance = 5e-5;
        EXPECT_TRUE(test::directions_agree(
            chi2, [&](test::Random& r) { return sampler.sample(r.pair()).direction; },
            [&](Vec3 d) { return sampler.pdf(sky_coordinates(d)); }));
    }
}

TEST(SkySampler, PdfOfASampleIsThatOfItsDirection) {
    const SkyMap map = test::random_sky(64, 32, 7);
    const SkySampler sampler(map);
    test::Random random(2);
    int different = 0;
    for (int i = 0; i < 100000; ++i) {
        const SkySampler::Sample s = sampler.sample(random.pair());
        ASSERT_NEAR(length(s.direction), 1.0, 3e-7);
        if (std::fabs(sampler.pdf(sky_coordinates(s.direction)) / s.pdf - 1) > 1e-5) ++different;
    }
    EXPECT_LE(different, 20);  // directions on a pixel's edge, by rounding
}

TEST(SkySampler, DensityIsPositiveWhereverTheLookupIs) {
    for (const SkyMap& map : {test::one_pixel_sky(32, 16, 0, 0, {0, 0, 5}),
                              test::one_pixel_sky(32, 16, 20, 9, {5, 0, 0}), test::random_sky(32, 16, 9)}) {
        const SkySampler sampler(map);
        test::Random random(3);
        for (int i = 0; i < 100000; ++i) {
            const Vec2 uv = random.pair();
            if (max_component(lookup(map, uv)) > 0) {
                ASSERT_GT(sampler.pdf(uv), 0.0f);
            }
        }
    }
}

TEST(SkySampler, AConstantMapIsSampledUniformly) {
    const SkySampler sampler(test::gradient_sky(64, 32, 1.0f, 0.0f));
    test::Random random(4);
    for (int i = 0; i < 1000; ++i)
        // Shares of 2^24: the smallest row has 40,000 units, a pixel of it 1/64 of all.
        ASSERT_NEAR(sampler.sample(random.pair()).pdf * 4 * 3.14159265358979, 1.0, 1e-3);
}

// What importance sampling is for: a map with a sun. Uniform directions would have a relative deviation of
// sqrt(4 pi / solid angle of the sun) = 190.
TEST(SkySampler, ASunInTheMapHardlyAddsNoise) {
    SkyMap map = test::gradient_sky(256, 128, 0.5f, 0.2f);
    map.radiance[40 * 256 + 100] = {40000, 40000, 40000};
    const test::Moments moments = integral_by_sampling(map, 100000);
    EXPECT_LT(std::sqrt(moments.variance()) / moments.mean(), 1.2);  // the bilinear tent in its nine pixels: 1.04
}

}  // namespace
}  // namespace lumel
