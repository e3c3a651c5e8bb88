#include "light/sphere.h"

#include <gtest/gtest.h>

#include "support/closed_forms.h"
#include "support/light_checks.h"

namespace lumel {
namespace {

const Vec3 kCenter{0.5f, 2.0f, -1.0f};

Light make_light(float radius) {
    Light light;
    light.shape = LightShape::sphere;
    light.position = kCenter;
    light.intensity = {2, 4, 3};
    light.radius = radius;
    return light;
}

// A normal at the given cosine to the direction of the sphere's centre.
Vec3 tilted(Vec3 point, double cosine) {
    const Vec3 axis = normalize(kCenter - point);
    return normalize(axis * static_cast<float>(cosine) +
                     Frame(axis).tangent * static_cast<float>(std::sqrt(1 - cosine * cosine)));
}

TEST(SphereLight, IrradianceIsThatOfACapCutByTheHorizon) {
    const Vec3 point{0.1f, 0.3f, 0.7f};
    for (const float radius : {0.01f, 0.5f, 2.0f, 2.43f})  // the last nearly touches the point, at distance 2.44
        for (const double cosine : {1.0, 0.5, 0.05, -0.1}) {
            const SphereLight light(make_light(radius));
            const Vec3 normal = tilted(point, cosine);
            const double expected = closed_form::sphere_light(point, normal, kCenter, radius, 4.0);
            const auto sample = [&](Vec2 u) { return light.sample(point, u); };
            EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal, 100000), expected, 1e-4, 16))
                << radius << " " << cosine;
        }
}

TEST(SphereLight, RaysAndSamplesTogetherGiveTheSame) {
    const Vec3 point{0.1f, 0.3f, 0.7f};
    const SphereLight light(make_light(1.2f));
    const Vec3 normal = tilted(point, 0.4);
    const double expected = closed_form::sphere_light(point, normal, kCenter, 1.2f, 4.0);
    const auto sample = [&](Vec2 u) { return light.sample(point, u); };
    const auto meet = [&](Vec3 d) { return light.intersect(point, d); };
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_rays(meet, normal), expected, 1e-4, 2));
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, meet, normal), expected, 1e-4, 2));
}

TEST(SphereLight, SamplesAreHitWithTheSameDistanceAndDensity) {
    for (const float radius : {0.001f, 0.1f, 2.4f, 5.0f, 100.0f}) {  // the last two from inside
        const SphereLight light(make_light(radius));
        const Vec3 point{0.1f, 0.3f, 0.7f};
        // Where the ray grazes a sphere of a thousandth of the distance, its chord is the square root of a small
        // difference: sqrt(1e-7) of the radius.
        test::expect_samples_hit([&](Vec2 u) { return light.sample(point, u); },
                                 [&](Vec3 d) { return light.intersect(point, d); }, 1e-3);
    }
}

TEST(SphereLight, SamplesFollowTheDensity) {
    const Vec3 point{0.1f, 0.3f, 0.7f};
    const SphereLight light(make_light(1.0f));
    test::DirectionTest chi2;
    chi2.axis = normalize(kCenter - point);
    chi2.min_cosine = 0.8;
    chi2.quadrature = 64;  // the cone's edge runs through a ring
    EXPECT_TRUE(test::directions_agree(
        chi2, [&](test::Random& r) { return light.sample(point, r.pair()).direction; },
        [&](Vec3 d) { return light.intersect(point, d).pdf; }));
}

TEST(SphereLight, FromInsideItGlowsAllAround) {
    const SphereLight light(make_light(1.0f));
    for (const Vec3 point : {kCenter, kCenter + Vec3{0.5f, 0.2f, 0.1f}, kCenter + Vec3{0, 0.999f, 0}}) {
        const auto sample = [&](Vec2 u) { return light.sample(point, u); };
        // A hemisphere of radiance L gives pi L.
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, {0, 0, 1}), 4.0 * closed_form::kPi, 1e-5));
        test::Random random(1);
        for (int i = 0; i < 1000; ++i) {
            const LightSample s = light.sample(point, random.pair());
            ASSERT_TRUE(is_finite(s.weight) && is_finite(s.direction) && std::isfinite(s.distance));
        }
    }
}

TEST(SphereLight, AFarAndSmallOneKeepsItsPower) {
    Light far = make_light(0.05f);
    far.position = {10000, 3000, -5000};
    const SphereLight light(far);
    const Vec3 point{0, 0, 0}, normal = normalize(far.position);
    const double expected = closed_form::sphere_light(point, normal, far.position, 0.05f, 4.0);
    const auto sample = [&](Vec2 u) { return light.sample(point, u); };
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal, 10000), expected, 1e-5));
}

TEST(SphereLight, PowerIsRadianceTimesPiTimesArea) {
    EXPECT_NEAR(SphereLight(make_light(0.5f)).power(), 3.0 * closed_form::kPi * closed_form::kPi, 1e-5);
}

TEST(SphereLight, RaysAwayFromItMiss) {
    const SphereLight light(make_light(0.5f));
    const Vec3 point{0, 0, 0};
    EXPECT_EQ(light.intersect(point, -normalize(kCenter)).pdf, 0.0f);
    EXPECT_EQ(light.intersect(point, {0, 0, 1}).pdf, 0.0f);
    EXPECT_GT(light.intersect(point, normalize(kCenter)).pdf, 0.0f);
}

}  // namespace
}  // namespace lumel
