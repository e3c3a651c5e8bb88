#include "light/sky_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/statistics.h"

namespace lumel {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

TEST(SkyCoordinates, FollowTheConventionOfSkyMap) {
    const auto expect = [](Vec3 d, float u, float v) {
        const Vec2 uv = sky_coordinates(d);
        EXPECT_NEAR(uv.x, u, 1e-7) << d.x << " " << d.y << " " << d.z;
        EXPECT_NEAR(uv.y, v, 1e-7) << d.x << " " << d.y << " " << d.z;
    };
    expect({1, 0, 0}, 0.5f, 0.5f);
    expect({0, 0, 1}, 0.75f, 0.5f);
    expect({0, 0, -1}, 0.25f, 0.5f);
    expect({-1, 0, 0}, 1.0f, 0.5f);
    expect({0, 1, 0}, 0.5f, 0.0f);
    expect({0, -1, 0}, 0.5f, 1.0f);
    const double s = std::sqrt(0.5);
    expect({static_cast<float>(s), static_cast<float>(s), 0}, 0.5f, 0.25f);
}

TEST(SkyCoordinates, AgreeWithTheFormulaEverywhere) {
    test::Random random(1);
    for (int i = 0; i < 200000; ++i) {
        const Vec3 d = normalize({random.unit() - 0.5f, random.unit() - 0.5f, random.unit() - 0.5f});
        const Vec2 uv = sky_coordinates(d);
        ASSERT_NEAR(uv.x, std::atan2(double{d.z}, double{d.x}) / (2 * kPiDouble) + 0.5, 1e-7);
        // The formula's arc sine loses digits towards the poles: 1e-7 / cos(latitude).
        const double cosine = std::sqrt(double{d.x} * d.x + double{d.z} * d.z);
        ASSERT_NEAR(uv.y, 0.5 - std::asin(double{d.y}) / kPiDouble, 1e-7 + 1e-7 / cosine);
    }
}

TEST(SkyCoordinates, UndoSkyDirection) {
    for (int i = 1; i < 64; ++i)
        for (int j = 1; j < 64; ++j) {
            const float u = static_cast<float>(i) / 64, v = static_cast<float>(j) / 64;
            const Vec3 d = sky_direction(u, v);
            EXPECT_NEAR(length(d), 1.0, 2e-7);
            EXPECT_NEAR(sky_coordinates(d).x, u, 1e-6);  // near the poles: 1e-7 / cos(latitude)
            EXPECT_NEAR(sky_coordinates(d).y, v, 1e-6);
        }
}

SkyMap make_map(std::uint32_t width, std::uint32_t height) {
    SkyMap map{width, height, std::vector<Vec3>(std::size_t{width} * height)};
    for (std::size_t i = 0; i < map.radiance.size(); ++i) {
        const auto x = static_cast<float>(i);
        map.radiance[i] = {x, 2 * x + 1, 100 - x};
    }
    return map;
}

TEST(SkyLookup, AtAPixelCentreIsThePixel) {
    const SkyMap map = make_map(8, 4);
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) {
            const Vec2 uv{(static_cast<float>(x) + 0.5f) / 8, (static_cast<float>(y) + 0.5f) / 4};
            EXPECT_EQ(lookup(map, uv), map.radiance[y * 8 + x]);
        }
}

TEST(SkyLookup, IsBilinearWrapsAcrossTheSeamAndClampsAtThePoles) {
    const SkyMap map = make_map(8, 4);
    EXPECT_EQ(lookup(map, Vec2{0.25f, 0.125f}).x, 1.5f);  // between pixels 1 and 2 of row 0
    EXPECT_EQ(lookup(map, Vec2{0.0f, 0.125f}).x, 3.5f);   // between 7 and 0
    EXPECT_EQ(lookup(map, Vec2{1.0f, 0.125f}).x, 3.5f);
    EXPECT_EQ(lookup(map, Vec2{0.0625f, 0.25f}).x, 4.0f);  // between rows 0 and 1
    EXPECT_EQ(lookup(map, Vec2{0.0625f, 0.0f}).x, 0.0f);   // the pole takes the first row
    EXPECT_EQ(lookup(map, Vec2{0.0625f, 1.0f}).x, 24.0f);
}

TEST(SkyIntegral, OfAConstantIsFourPi) {
    SkyMap map = make_map(16, 8);
    for (Vec3& c : map.radiance) c = {1, 2, 0.5f};
    const auto total = integrate(map);
    EXPECT_NEAR(total[0], 4 * kPiDouble, 1e-12);
    EXPECT_NEAR(total[1], 8 * kPiDouble, 1e-12);
    EXPECT_NEAR(total[2], 2 * kPiDouble, 1e-12);
}

}  // namespace
}  // namespace lumel
