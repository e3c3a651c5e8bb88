#include <gtest/gtest.h>

#include <cmath>

#include "light/sky_map.h"
#include "math/constants.h"
#include "support/sky_maps.h"

namespace lumel {
namespace {

constexpr float kDegrees = kPi / 180.0f;

void expect_same_integral(const SkyMap& a, const SkyMap& b) {
    const auto x = integrate(a), y = integrate(b);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(y[k] / x[k], 1.0, 1e-6) << k;  // rounding of float pixels
}

TEST(SkyBlur, KeepsTheIntegralOfEveryChannel) {
    for (const float degrees : {1.0f, 5.0f, 10.0f, 33.0f, 90.0f, 180.0f}) {
        const SkyMap random = test::random_sky(64, 32, 1);
        expect_same_integral(random, blur_sky(random, degrees * kDegrees));
        const SkyMap pole = test::one_pixel_sky(64, 32, 10, 0, {1, 20, 300});
        expect_same_integral(pole, blur_sky(pole, degrees * kDegrees));
    }
}

TEST(SkyBlur, LeavesAConstantAlone) {
    SkyMap map = test::gradient_sky(64, 32, 1.0f, 0.0f);
    const SkyMap blurred = blur_sky(map, 15 * kDegrees);
    for (const Vec3 c : blurred.radiance) {
        EXPECT_NEAR(c.x, 0.5, 1e-6);
        EXPECT_NEAR(c.y, 1.0, 1e-6);
        EXPECT_NEAR(c.z, 2.0, 2e-6);
    }
}

TEST(SkyBlur, LessThanAPixelChangesNothing) {
    const SkyMap map = test::random_sky(64, 32, 2);
    EXPECT_EQ(blur_sky(map, 0.0f).radiance, map.radiance);
    EXPECT_EQ(blur_sky(map, 1.0f * kDegrees).radiance, map.radiance);  // a pixel has 5.6 degrees
}

TEST(SkyBlur, TheWholeSphereGivesTheMeanEverywhere) {
    const SkyMap map = test::random_sky(32, 16, 3);
    const double mean = integrate(map)[1] / (4 * 3.14159265358979);
    for (const Vec3 c : blur_sky(map, 180 * kDegrees).radiance) EXPECT_NEAR(c.y / mean, 1.0, 1e-5);
}

// One pixel becomes a cap of uniform radiance with the same integral, at the equator and near the pole.
TEST(SkyBlur, OnePixelBecomesACap) {
    constexpr float kHalfAngle = 20 * kDegrees;
    for (const std::uint32_t row : {64u, 20u, 5u}) {
        const SkyMap map = test::one_pixel_sky(256, 128, 30, row, {0, 1000, 0});
        const SkyMap blurred = blur_sky(map, kHalfAngle);
        const Vec3 center = sky_direction(30.5f / 256, (static_cast<float>(row) + 0.5f) / 128);
        const double cap = 2 * 3.14159265358979 * (1 - std::cos(kHalfAngle));
        const double inside = integrate(map)[1] / cap;
        for (std::uint32_t y = 0; y < 128; ++y)
            for (std::uint32_t x = 0; x < 256; ++x) {
                const Vec3 d =
                    sky_direction((static_cast<float>(x) + 0.5f) / 256, (static_cast<float>(y) + 0.5f) / 128);
                const double angle = std::acos(std::min(1.0f, dot(d, center)));
                const double value = blurred.radiance[y * 256 + x].y;
                // A pixel and a half of the edge, 1.4 degrees each, is neither; the normalisation of discs of some 600
                // pixels is good to a few per cent.
                if (angle < kHalfAngle - 2.1 * kDegrees) {
                    EXPECT_NEAR(value / inside, 1.0, 0.03) << row << " " << x << " " << y;
                }
                if (angle > kHalfAngle + 2.1 * kDegrees) {
                    EXPECT_EQ(value, 0.0) << row << " " << x << " " << y;
                }
            }
    }
}

// Funk-Hecke: a cap multiplies the band-1 part of a + b d.y by (1 + cos)/2 and leaves the constant.
TEST(SkyBlur, AGradientKeepsItsShapeAndLosesContrast) {
    const float half_angle = 40 * kDegrees;
    const SkyMap blurred = blur_sky(test::gradient_sky(128, 64, 1.0f, 0.9f), half_angle);
    const SkyMap expected = test::gradient_sky(128, 64, 1.0f, 0.9f * 0.5f * (1 + std::cos(half_angle)));
    for (std::size_t i = 0; i < expected.radiance.size(); ++i)
        EXPECT_NEAR(blurred.radiance[i].y, expected.radiance[i].y, 2e-3);  // the map's rows are 2.8 degrees
}

// A cap of many rows leaves nothing that a smaller map could not hold.
TEST(SkyBlur, OfALargeMapIsASmallerOne) {
    const float half_angle = 40 * kDegrees;
    const SkyMap map = test::gradient_sky(1024, 512, 1.0f, 0.9f);
    const SkyMap blurred = blur_sky(map, half_angle);
    EXPECT_EQ(blurred.height, 128u) << "40 degrees are 28 of its rows";
    ASSERT_EQ(blurred.width, 256u);
    expect_same_integral(map, blurred);
    const SkyMap expected =
        test::gradient_sky(blurred.width, blurred.height, 1.0f, 0.9f * 0.5f * (1 + std::cos(half_angle)));
    for (std::size_t i = 0; i < expected.radiance.size(); ++i)
        EXPECT_NEAR(blurred.radiance[i].y, expected.radiance[i].y, 1e-3);  // its rows are 1.4 degrees
}

}  // namespace
}  // namespace lumel
