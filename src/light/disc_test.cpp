#include "light/disc.h"

#include <gtest/gtest.h>

#include "support/closed_forms.h"
#include "support/light_checks.h"

namespace lumel {
namespace {

Light make_light() {
    Light light;
    light.shape = LightShape::disc;
    light.position = {0.2f, 1.5f, -0.3f};
    light.half_u = {0.8f, 0, 0};
    light.half_v = {0, 0, 0.8f};
    light.direction = {0, -1, 0};
    light.intensity = {2, 5, 3};
    return light;
}

TEST(DiscLight, IrradianceOfAParallelPlaneIsTheClosedForm) {
    const Light light = make_light();
    const DiscLight disc(light);
    constexpr Vec3 kUp{0, 1, 0};
    for (const float offset : {0.0f, 0.5f, 0.8f, 3.0f}) {
        const Vec3 point{0.2f + offset, 0, -0.3f};
        const double expected = closed_form::parallel_disc_light(0.8f, 1.5, offset, 5.0);
        const auto sample = [&](Vec2 u) { return disc.sample(point, u); };
        const auto meet = [&](Vec3 d) { return disc.intersect(point, d); };
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, kUp), expected, 1e-4, 8)) << offset;
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, meet, kUp), expected, 1e-4, 8)) << offset;
        test::expect_samples_hit(sample, meet, 1e-5);
    }
}

TEST(DiscLight, SamplesFollowTheDensity) {
    const DiscLight disc(make_light());
    const Vec3 point{0.9f, 0.6f, 0};
    test::DirectionTest chi2;
    chi2.axis = normalize(make_light().position - point);
    chi2.min_cosine = 0.3;
    chi2.quadrature = 64;
    EXPECT_TRUE(test::directions_agree(
        chi2, [&](test::Random& r) { return disc.sample(point, r.pair()).direction; },
        [&](Vec3 d) { return disc.intersect(point, d).pdf; }));
}

TEST(DiscLight, AnEllipseIsMetAsItIsSampled) {
    Light light = make_light();
    light.half_v = {0, 0, 0.3f};
    const DiscLight ellipse(light);
    const Vec3 point{0, 0.4f, 0}, normal = normalize({0.2f, 1, 0.3f});
    const auto sample = [&](Vec2 u) { return ellipse.sample(point, u); };
    const auto meet = [&](Vec3 d) { return ellipse.intersect(point, d); };
    // No closed form: rays alone are the reference; the difference has both errors.
    const test::Moments by_rays = test::irradiance_by_rays(meet, normal),
                        by_light = test::irradiance_by_light(sample, normal);
    const double error = std::hypot(by_rays.standard_error(), by_light.standard_error());
    EXPECT_NEAR(by_light.mean(), by_rays.mean(), test::z_limit(1e-4) * error);
    EXPECT_NEAR(ellipse.power(), closed_form::kPi * closed_form::kPi * 0.8 * 0.3 * 10 / 3, 1e-5);
}

TEST(DiscLight, IsDarkBehindAndRound) {
    const DiscLight disc(make_light());
    EXPECT_EQ(disc.sample({0, 2, 0}, {0.5f, 0.5f}).distance, 0.0f);
    EXPECT_EQ(disc.intersect({0.2f, 2, -0.3f}, {0, -1, 0}).pdf, 0.0f);
    EXPECT_GT(disc.intersect({0.2f + 0.79f, 0, -0.3f}, {0, 1, 0}).pdf, 0.0f);
    EXPECT_EQ(disc.intersect({0.2f + 0.6f, 0, -0.3f + 0.6f}, {0, 1, 0}).pdf, 0.0f);  // in the corner of its square
}

}  // namespace
}  // namespace lumel
