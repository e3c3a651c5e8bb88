#include "light/punctual.h"

#include <gtest/gtest.h>

#include "support/closed_forms.h"
#include "support/light_checks.h"

namespace lumel {
namespace {

Light make_point(float radius) {
    Light light;
    light.shape = LightShape::point;
    light.position = {1, 3, 2};
    light.intensity = {20, 50, 30};
    light.radius = radius;
    return light;
}

Light make_spot(float radius) {
    Light light = make_point(radius);
    light.shape = LightShape::spot;
    light.direction = normalize({0.2f, -1, 0.1f});
    light.inner_cone = 0.3f;
    light.outer_cone = 0.6f;
    return light;
}

constexpr Vec3 kUp{0, 1, 0};

double irradiance(const PunctualLight& light, Vec3 point) {
    return test::irradiance_by_light([&](Vec2 u) { return light.sample(point, u); }, kUp, 1).mean();
}

TEST(PointLight, FollowsTheInverseSquareAndCosine) {
    const Light light = make_point(0.0f);
    for (const Vec3 p : {Vec3{1, 0, 2}, Vec3{0, 0, 0}, Vec3{-5, 1, 9}, Vec3{1, 2.99f, 2}}) {
        const double expected = closed_form::point_light(p, kUp, light.position, 50);
        EXPECT_NEAR(irradiance(PunctualLight(light), p) / expected, 1.0, 1e-5);  // float rounding
    }
}

TEST(PointLight, SampleIsADelta) {
    const LightSample s = PunctualLight(make_point(0.0f)).sample({1, 0, 2}, {0.2f, 0.7f});
    EXPECT_EQ(s.pdf, 0.0f);
    EXPECT_FLOAT_EQ(s.distance, 3.0f);
    EXPECT_EQ(s.direction, kUp);
    EXPECT_FALSE(PunctualLight(make_point(0.0f)).can_be_hit());
}

TEST(PointLight, AtItsOwnPlaceGivesNoSampleAndNoNan) {
    EXPECT_EQ(PunctualLight(make_point(0.0f)).sample({1, 3, 2}, {0.2f, 0.7f}).distance, 0.0f);
    const LightSample s = PunctualLight(make_spot(0.5f)).sample({1, 3, 2}, {0.2f, 0.7f});
    EXPECT_TRUE(is_finite(s.weight) && is_finite(s.direction));
}

TEST(PointLight, RangeWindowIsThatOfTheExtension) {
    Light light = make_point(0.0f);
    light.range = 4.0f;
    const PunctualLight windowed(light);
    for (const float d : {0.5f, 2.0f, 3.0f, 3.9f}) {
        const Vec3 p{1, 3 - d, 2};
        EXPECT_NEAR(irradiance(windowed, p), 50.0 / (d * d) * closed_form::range_window(d, 4), 1e-4 / (d * d));
    }
    EXPECT_EQ(windowed.sample({1, -1.0f, 2}, {}).distance, 0.0f);
    EXPECT_EQ(windowed.sample({1, -9.0f, 2}, {}).distance, 0.0f);
}

TEST(SpotLight, ConeIsThatOfTheExtension) {
    const Light light = make_spot(0.0f);
    const PunctualLight spot(light);
    int lit = 0, dark = 0, ramp = 0;
    for (float x = -4; x <= 6; x += 0.37f) {
        const Vec3 p{x, 0, 2.2f};
        const double factor =
            closed_form::spot_factor(light.direction, closed_form::Vec(p) - light.position, 0.3f, 0.6f);
        const double expected = closed_form::point_light(p, kUp, light.position, 50) * factor;
        // The ramp multiplies the rounding of the cosine by 1 / (cos inner - cos outer) = 8.
        EXPECT_NEAR(irradiance(spot, p), expected, 2e-5) << x;
        (factor == 1 ? lit : factor == 0 ? dark : ramp) += 1;
    }
    EXPECT_GT(lit, 2);
    EXPECT_GT(dark, 2);
    EXPECT_GT(ramp, 2);
}

TEST(SpotLight, EqualConesAreAHardEdge) {
    Light light = make_spot(0.0f);
    light.inner_cone = light.outer_cone = 0.5f;
    light.direction = {0, -1, 0};
    const PunctualLight spot(light);
    const auto at = [&](float angle) { return irradiance(spot, light.position + Vec3{std::tan(angle), -1, 0}); };
    EXPECT_GT(at(0.49f), 0.0);
    EXPECT_EQ(at(0.51f), 0.0);
}

TEST(PointLightWithRadius, LooksTheSameFromAfar) {
    for (const float radius : {0.01f, 0.3f}) {
        const Light light = make_point(radius);
        const PunctualLight sphere(light);
        // A sphere wholly above the horizon gives what a point of the same intensity gives, at any distance.
        for (const Vec3 p : {Vec3{1, 0, 2}, Vec3{0, 1, 0}, Vec3{30, 0, 2}}) {
            const double expected = closed_form::point_light(p, kUp, light.position, 50);
            const auto sample = [&](Vec2 u) { return sphere.sample(p, u); };
            EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, kUp, 100000), expected, 1e-4, 6)) << radius;
        }
    }
}

TEST(SpotLightWithRadius, RaysAndSamplesAgree) {
    const Light light = make_spot(0.4f);
    const PunctualLight spot(light);
    const Vec3 point{0.3f, 0.5f, 2.4f};
    const double factor =
        closed_form::spot_factor(light.direction, closed_form::Vec(point) - light.position, 0.3f, 0.6f);
    ASSERT_GT(factor, 0.1);
    const double expected = factor * closed_form::point_light(point, kUp, light.position, 50);
    const auto sample = [&](Vec2 u) { return spot.sample(point, u); };
    const auto meet = [&](Vec3 d) { return spot.intersect(point, d); };
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, kUp), expected, 1e-4, 3));
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_rays(meet, kUp), expected, 1e-4, 3));
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, meet, kUp), expected, 1e-4, 3));
    test::expect_samples_hit(sample, meet, 1e-4);
}

TEST(SpotLight, PowerIsTheIntegralOfItsIntensity) {
    const Light light = make_spot(0.0f);
    test::Random random(1);
    test::Moments power;
    for (int i = 0; i < 400000; ++i) {
        const Vec3 d = direction_from_z(1 - 2 * random.unit(), random.unit());
        power.add(4 * closed_form::kPi * strength(light.intensity) *
                  closed_form::spot_factor(light.direction, d, 0.3f, 0.6f));
    }
    EXPECT_TRUE(test::mean_agrees(power, PunctualLight(light).power(), 1e-4));
}

}  // namespace
}  // namespace lumel
