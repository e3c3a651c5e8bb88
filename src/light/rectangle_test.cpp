#include "light/rectangle.h"

#include <gtest/gtest.h>

#include "support/closed_forms.h"
#include "support/light_checks.h"

namespace lumel {
namespace {

// 2 x 1, half a metre... two metres above the floor, facing down and a little aside.
Light make_light() {
    Light light;
    light.shape = LightShape::rectangle;
    light.position = {0.2f, 2.0f, -0.3f};
    light.half_u = normalize({1, 0.3f, 0}) * 1.0f;
    light.half_v = normalize(cross(Vec3{0, 0, 1}, Vec3{1, 0.3f, 0})) * 0.0f + Vec3{0, 0, 0.5f};
    light.direction = normalize(cross(light.half_u, light.half_v));
    light.intensity = {2, 5, 3};
    return light;
}

double exact(const Light& l, Vec3 point, Vec3 normal) {
    return closed_form::rectangle_light(point, normal, l.position, l.half_u, l.half_v, l.intensity.y);
}

struct Place {
    const char* name;
    Vec3 point;
    Vec3 normal;
    double tolerance;  // of a hit's density: float directions at grazing angles
};

const std::vector<Place> kPlaces{
    {"below", {0, 0, 0}, {0, 1, 0}, 1e-5},
    {"aside, cut by the horizon", {2.5f, 1.0f, 0.5f}, normalize({-0.2f, 1, 0.9f}), 1e-5},
    {"close under it", {0.3f, 1.9f, -0.4f}, {0, 1, 0}, 1e-4},
    {"grazing", {3.0f, 2.5f, 0.0f}, normalize({-1, 0, 0}), 1e-3},
    {"far, by area", {40, -100, 30}, normalize({-0.3f, 1, -0.2f}), 1e-4},
};

TEST(RectangleLight, IrradianceIsLambertsPolygon) {
    const Light light = make_light();
    const RectangleLight rectangle(light);
    for (const Place& place : kPlaces) {
        const double expected = exact(light, place.point, place.normal);
        ASSERT_GT(expected, 0.0) << place.name;
        const auto sample = [&](Vec2 u) { return rectangle.sample(place.point, u); };
        const auto meet = [&](Vec3 d) { return rectangle.intersect(place.point, d); };
        const std::size_t tests = 2 * kPlaces.size();
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, place.normal), expected, 1e-4, tests))
            << place.name;
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, meet, place.normal), expected, 1e-4, tests))
            << place.name;
    }
}

TEST(RectangleLight, SamplesAreHitWithTheSameDistanceAndDensity) {
    const RectangleLight rectangle(make_light());
    for (const Place& place : kPlaces) {
        SCOPED_TRACE(place.name);
        test::expect_samples_hit([&](Vec2 u) { return rectangle.sample(place.point, u); },
                                 [&](Vec3 d) { return rectangle.intersect(place.point, d); }, place.tolerance);
    }
}

TEST(RectangleLight, SamplesAreUniformInSolidAngle) {
    const Light light = make_light();
    const RectangleLight rectangle(light);
    for (const Vec3 point : {Vec3{0, 0, 0}, Vec3{0.9f, 1.5f, 0.2f}, Vec3{3.0f, 2.5f, 0.0f}}) {
        test::DirectionTest chi2;
        chi2.axis = normalize(light.position - point);
        chi2.min_cosine = point.y < 1 ? 0.8 : point.y < 2 ? -0.5 : 0.85;
        chi2.quadrature = 64;  // edges run through cells
        chi2.significance = test::sidak(1e-4, 3);
        EXPECT_TRUE(test::directions_agree(
            chi2, [&](test::Random& r) { return rectangle.sample(point, r.pair()).direction; },
            [&](Vec3 d) { return rectangle.intersect(point, d).pdf; }))
            << point.x;
    }
}

TEST(RectangleLight, ShearedOnesAreSampledByArea) {
    Light light = make_light();
    light.half_v = light.half_v + light.half_u * 0.4f;
    const RectangleLight sheared(light);
    const Vec3 point{0.5f, 0.8f, 0.1f}, normal = normalize({0.1f, 1, -0.2f});
    const auto sample = [&](Vec2 u) { return sheared.sample(point, u); };
    const auto meet = [&](Vec3 d) { return sheared.intersect(point, d); };
    const double expected = exact(light, point, normal);
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal), expected, 1e-4, 2));
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, meet, normal), expected, 1e-4, 2));
    test::expect_samples_hit(sample, meet, 1e-5);
}

TEST(RectangleLight, IsDarkBehind) {
    const Light light = make_light();
    const RectangleLight rectangle(light);
    const Vec3 behind = light.position - light.direction;
    EXPECT_EQ(rectangle.sample(behind, {0.5f, 0.5f}).distance, 0.0f);
    EXPECT_EQ(rectangle.intersect(behind, light.direction).pdf, 0.0f);
    EXPECT_EQ(rectangle.sample(light.position, {0.5f, 0.5f}).distance, 0.0f);  // in its plane
}

TEST(RectangleLight, TheLitSideIsTheDirectionWhateverTheOrderOfTheEdges) {
    Light light = make_light();
    std::swap(light.half_u, light.half_v);
    EXPECT_GT(RectangleLight(light).sample(light.position + light.direction, {0.5f, 0.5f}).distance, 0.0f);
    EXPECT_EQ(RectangleLight(light).sample(light.position - light.direction, {0.5f, 0.5f}).distance, 0.0f);
}

// Steradians of a rectangle from any distance: against Girard's polygon where that has digits, against area over
// squared distance where it has none.
TEST(RectangleView, SolidAngle) {
    const RectangleLight::View above{-1, 1, -1, 1, 1};
    EXPECT_NEAR(above.solid_angle(), 2 * closed_form::kPi / 3, 1e-14);  // a face of a cube: a sixth of the sphere
    const RectangleLight::View corner{0, 1, 0, 1, 1};
    EXPECT_NEAR(corner.solid_angle(), closed_form::kPi / 6, 1e-14);
    const RectangleLight::View huge{-1e6, 1e6, -1e6, 1e6, 1};
    EXPECT_NEAR(huge.solid_angle(), 2 * closed_form::kPi, 1e-5);
    const RectangleLight::View far{-1, 1, -1, 1, 1e4};
    EXPECT_NEAR(far.solid_angle() / 4e-8, 1.0, 1e-7);
}

TEST(RectangleView, PositionsStayInsideAtTheExtremes) {
    for (const double height : {1e-12, 1e-6, 1.0, 1e3})
        for (const double offset : {0.0, 0.999999, 1.0, 1.000001, 30.0})
            for (const float u : {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f})
                for (const float v : {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f}) {
                    const RectangleLight::View view{offset - 1, offset + 1, -0.5, 0.5, height};
                    const auto p = view.sample({u, v});
                    ASSERT_TRUE(p.x >= view.x0 && p.x <= view.x1 && p.y >= view.y0 && p.y <= view.y1)
                        << height << " " << offset << " " << u << " " << v << ": " << p.x << " " << p.y;
                }
}

TEST(RectangleLight, PowerIsRadianceTimesPiTimesArea) {
    EXPECT_NEAR(RectangleLight(make_light()).power(), closed_form::kPi * 2.0 * 10.0 / 3.0, 1e-5);
}

}  // namespace
}  // namespace lumel
