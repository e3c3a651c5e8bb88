#include "light/sun.h"

#include <gtest/gtest.h>

#include "support/closed_forms.h"
#include "support/light_checks.h"

namespace lumel {
namespace {

const Vec3 kTowards = normalize({0.3f, 0.8f, -0.4f});
constexpr float kHalfDegree = 0.00925f;  // the real sun's diameter

Light make_light(float angular_diameter) {
    Light light;
    light.shape = LightShape::sun;
    light.direction = -kTowards;
    light.intensity = {3, 7, 5};
    light.angular_diameter = angular_diameter;
    return light;
}

TEST(Sun, WithoutAngleIsADeltaOfItsIlluminance) {
    const SunLight sun(make_light(0.0f));
    const LightSample s = sun.sample({0.3f, 0.9f});
    EXPECT_EQ(s.direction, kTowards);
    EXPECT_EQ(s.distance, kInfiniteDistance);
    EXPECT_EQ(s.weight, (Vec3{3, 7, 5}));
    EXPECT_EQ(s.pdf, 0.0f);
    EXPECT_EQ(sun.intersect(kTowards).pdf, 0.0f);
    EXPECT_EQ(sun.intersect(kTowards).radiance, Vec3{});
}

TEST(Sun, IrradianceOnAFacingPlaneIsTheIlluminanceAtEveryAngle) {
    for (const float diameter : {1e-5f, kHalfDegree, 0.1f, 1.5707963f}) {
        const SunLight sun(make_light(diameter));
        const auto sample = [&](Vec2 u) { return sun.sample(u); };
        // 3e-7: rounding of the cosine, which exceeds the noise of a tiny sun.
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, kTowards), 7.0, 1e-5)) << diameter;
    }
}

TEST(Sun, IrradianceOnTiltedPlanesIsThatOfACapCutByTheHorizon) {
    // Above the horizon, cut by it above and below its centre, below it.
    for (const float diameter : {kHalfDegree, 0.5f})
        for (const double elevation : {1.0, 0.1, -0.1, 0.002, -0.002}) {
            const SunLight sun(make_light(diameter));
            const Frame frame(kTowards);
            const Vec3 normal = normalize(frame.tangent * static_cast<float>(std::cos(elevation)) +
                                          kTowards * static_cast<float>(std::sin(elevation)));
            const double expected = closed_form::sun(normal, kTowards, diameter, 7.0);
            const auto sample = [&](Vec2 u) { return sun.sample(u); };
            // The sine of the elevation is a difference of float products, good to 1e-7 of 7 lux.
            EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal), expected, 1e-5, 10,
                                          expected > 0 ? 1e-5 + 1e-6 / expected : 0))
                << diameter << " " << elevation;
        }
}

TEST(Sun, SamplesFillTheConeUniformly) {
    for (const float diameter : {kHalfDegree, 0.5f}) {
        const SunLight sun(make_light(diameter));
        test::DirectionTest chi2;
        chi2.axis = kTowards;
        chi2.min_cosine = 1 - 1.25 * 2 * std::pow(std::sin(diameter / 4), 2);
        chi2.rings = 20;  // the cone ends at the edge of ring 16
        chi2.significance = 5e-5;
        EXPECT_TRUE(test::directions_agree(
            chi2, [&](test::Random& r) { return sun.sample(r.pair()).direction; },
            [&](Vec3 d) { return sun.intersect(d).pdf; }))
            << diameter;
    }
}

TEST(Sun, SamplesAreHitWithTheSameDensity) {
    for (const float diameter : {1e-3f, kHalfDegree, 0.5f}) {
        const SunLight sun(make_light(diameter));
        test::expect_samples_hit([&](Vec2 u) { return sun.sample(u); }, [&](Vec3 d) { return sun.intersect(d); }, 1e-6);
    }
}

TEST(Sun, TheEdgeOfARealSunIsWhereItShouldBe) {
    const SunLight sun(make_light(kHalfDegree));
    const Frame frame(kTowards);
    const auto at = [&](float angle) {
        return sun.intersect(normalize(kTowards * std::cos(angle) + frame.tangent * std::sin(angle))).pdf > 0.0f;
    };
    // 1e-4 of the radius: what float directions resolve (6e-8 / 0.0046 with a margin).
    EXPECT_TRUE(at(0.5f * kHalfDegree * 0.9999f));
    EXPECT_FALSE(at(0.5f * kHalfDegree * 1.0001f));
    EXPECT_EQ(sun.intersect(-kTowards).pdf, 0.0f);
}

}  // namespace
}  // namespace lumel
