// One light over a black floor: every texel against the closed form averaged over its sample points.
#include <gtest/gtest.h>

#include "baked_page.h"
#include "math/constants.h"
#include "support/closed_forms.h"
#include "support/sky_maps.h"

namespace lumel {
namespace {

constexpr double kMeanTolerance = 0.003;
constexpr Vec3 kColor{0.5f, 1.0f, 1.5f};

// 4 x 4 metres, centred, facing up.
const test::Square kFloor{{-2, 0, -2}, {0, 0, 4}, {4, 0, 0}};
constexpr Vec3 kUp{0, 1, 0};

// `irradiance(point)`: E of a light of unit strength.
template <class Irradiance>
void expect_floor(const Scene& scene, std::uint32_t samples, Irradiance&& irradiance) {
    const auto texels = test::bake_texels(scene, kFloor.options(samples));
    ASSERT_EQ(texels.size(), kFloor.edge * kFloor.edge);
    test::expect_texels(
        texels,
        [&](const test::BakedTexel& texel) {
            const double i = kFloor.mean_over(texel, irradiance) / closed_form::kPi;
            return std::array<double, 3>{i * kColor.x, i * kColor.y, i * kColor.z};
        },
        kMeanTolerance);
}

struct FloorScene {
    test::SceneBuilder builder;
    FloorScene() { kFloor.add_to(builder, builder.material({0, 0, 0})); }
    Light& light(LightShape shape, float strength) {
        Light& light = builder.light(shape);
        light.intensity = kColor * strength;
        return light;
    }
};

TEST(LightOverPlane, Point) {
    FloorScene s;
    s.light(LightShape::point, 100).position = {0.3f, 1.2f, -0.5f};
    expect_floor(s.builder.build(), 64, [](Vec3 p) {
        return closed_form::point_light(p, kUp, Vec3{0.3f, 1.2f, -0.5f}, 100);
    });
}

TEST(LightOverPlane, PointWithRange) {
    FloorScene s;
    Light& light = s.light(LightShape::point, 100);
    light.position = {0.3f, 1.2f, -0.5f};
    light.range = 2.5f;
    expect_floor(s.builder.build(), 64, [](Vec3 p) {
        const Vec3 position{0.3f, 1.2f, -0.5f};
        return closed_form::point_light(p, kUp, position, 100) *
               closed_form::range_window(closed_form::length(closed_form::Vec(position) - p), 2.5);
    });
}

// Wholly above the horizon a sphere of the same intensity lights as a point does.
TEST(LightOverPlane, PointWithRadius) {
    FloorScene s;
    Light& light = s.light(LightShape::point, 100);
    light.position = {0.3f, 1.2f, -0.5f};
    light.radius = 0.4f;
    expect_floor(s.builder.build(), 512, [](Vec3 p) {
        return closed_form::point_light(p, kUp, Vec3{0.3f, 1.2f, -0.5f}, 100);
    });
}

void set_spot(Light& light) {
    light.position = {-0.4f, 2.0f, 0.2f};
    light.direction = normalize({0.4f, -1, 0.2f});
    light.inner_cone = 0.25f;
    light.outer_cone = 0.7f;
}
double spot_irradiance(Vec3 p) {
    const Vec3 position{-0.4f, 2.0f, 0.2f};
    return closed_form::point_light(p, kUp, position, 100) *
           closed_form::spot_factor(normalize({0.4f, -1, 0.2f}), closed_form::Vec(p) - position, 0.25f, 0.7f);
}

TEST(LightOverPlane, Spot) {
    FloorScene s;
    set_spot(s.light(LightShape::spot, 100));
    expect_floor(s.builder.build(), 64, spot_irradiance);
}

TEST(LightOverPlane, SpotWithRadius) {
    FloorScene s;
    Light& light = s.light(LightShape::spot, 100);
    set_spot(light);
    light.radius = 0.3f;
    expect_floor(s.builder.build(), 512, spot_irradiance);
}

TEST(LightOverPlane, Sun) {
    const Vec3 towards = normalize({0.4f, 0.8f, -0.3f});
    for (const float degrees : {0.0f, 0.53f, 20.0f}) {
        SCOPED_TRACE(degrees);
        FloorScene s;
        Light& light = s.light(LightShape::sun, 1000);
        light.direction = -towards;
        light.angular_diameter = degrees * kPi / 180;
        expect_floor(s.builder.build(), 512, [&](Vec3) {
            return closed_form::sun(kUp, towards, double{degrees} * closed_form::kPi / 180, 1000);
        });
    }
}

TEST(LightOverPlane, SunCutByTheHorizon) {
    const Vec3 towards = normalize({1, 0.05f, 0.5f});
    FloorScene s;
    Light& light = s.light(LightShape::sun, 1000);
    light.direction = -towards;
    light.angular_diameter = 0.3f;
    expect_floor(s.builder.build(), 512, [&](Vec3) { return closed_form::sun(kUp, towards, 0.3f, 1000); });
}

TEST(LightOverPlane, Rectangle) {
    FloorScene s;
    Light& light = s.light(LightShape::rectangle, 10);
    light.position = {0.2f, 0.8f, -0.3f};
    light.half_u = {0.7f, 0.2f, 0};
    light.half_v = {0, 0, 0.4f};
    light.direction = normalize(cross(light.half_u, light.half_v));
    expect_floor(s.builder.build(), 512, [](Vec3 p) {
        return closed_form::rectangle_light(p, kUp, Vec3{0.2f, 0.8f, -0.3f}, Vec3{0.7f, 0.2f, 0}, Vec3{0, 0, 0.4f}, 10);
    });
}

TEST(LightOverPlane, Disc) {
    FloorScene s;
    Light& light = s.light(LightShape::disc, 10);
    light.position = {0.2f, 0.6f, -0.3f};
    light.half_u = {0.8f, 0, 0};
    light.half_v = {0, 0, 0.8f};
    light.direction = {0, -1, 0};
    expect_floor(s.builder.build(), 512, [](Vec3 p) {
        return closed_form::parallel_disc_light(0.8f, 0.6f, std::hypot(p.x - 0.2, p.z + 0.3), 10);
    });
}

TEST(LightOverPlane, Sphere) {
    FloorScene s;
    Light& light = s.light(LightShape::sphere, 10);
    light.position = {0.2f, 0.9f, -0.3f};
    light.radius = 0.5f;
    expect_floor(s.builder.build(), 512, [](Vec3 p) {
        return closed_form::sphere_light(p, kUp, Vec3{0.2f, 0.9f, -0.3f}, 0.5f, 10);
    });
}

TEST(LightOverPlane, SphereCutByTheHorizon) {
    FloorScene s;
    Light& light = s.light(LightShape::sphere, 10);
    light.position = {3.2f, 0.2f, 0.1f};  // beside the floor
    light.radius = 1.0f;
    expect_floor(s.builder.build(), 512, [](Vec3 p) {
        return closed_form::sphere_light(p, kUp, Vec3{3.2f, 0.2f, 0.1f}, 1.0f, 10);
    });
}

TEST(LightOverPlane, UniformSky) {
    FloorScene s;
    s.builder.scene().sky.color = kColor * 3.0f;
    expect_floor(s.builder.build(), 1024, [](Vec3) { return 3.0 * closed_form::kPi; });
}

TEST(LightOverPlane, GradientSky) {
    FloorScene s;
    SkyMap map = test::gradient_sky(256, 128, 1.0f, 0.8f);
    for (Vec3& c : map.radiance) c = kColor * c.y;
    s.builder.scene().sky.map = map;
    expect_floor(s.builder.build(), 1024, [](Vec3) { return closed_form::gradient_sky(Vec3{0, 1, 0}, 1.0, 0.8); });
}

// A sky of one small bright patch: what a sun in the map looks like. E of the bilinear tent by its integral.
TEST(LightOverPlane, SunInASkyMap) {
    FloorScene s;
    SkyMap map = test::one_pixel_sky(128, 64, 40, 12, kColor * 10000.0f);
    s.builder.scene().sky.map = map;
    double expected = 0;
    constexpr int kSteps = 64;
    for (int j = 0; j < 3 * kSteps; ++j)
        for (int i = 0; i < 3 * kSteps; ++i) {
            const double u = (39 + (i + 0.5) / kSteps) / 128, v = (11 + (j + 0.5) / kSteps) / 64;
            const double sine = std::cos(v * closed_form::kPi), cosine = std::sin(v * closed_form::kPi);
            expected += lookup(map, Vec2{static_cast<float>(u), static_cast<float>(v)}).y * sine * cosine;
        }
    expected *= 2 * closed_form::kPi * closed_form::kPi / (128.0 * 64 * kSteps * kSteps);
    expect_floor(s.builder.build(), 1024, [&](Vec3) { return expected; });
}

// All at once: the sum.
TEST(LightOverPlane, SeveralLightsAddUp) {
    FloorScene s;
    s.light(LightShape::point, 20).position = {0.3f, 1.2f, -0.5f};
    Light& sphere = s.light(LightShape::sphere, 10);
    sphere.position = {-1, 0.9f, 1};
    sphere.radius = 0.3f;
    s.light(LightShape::sun, 20).direction = {0, -1, 0};
    s.builder.scene().sky.color = kColor * 2.0f;
    expect_floor(s.builder.build(), 1024, [](Vec3 p) {
        return closed_form::point_light(p, kUp, Vec3{0.3f, 1.2f, -0.5f}, 20) +
               closed_form::sphere_light(p, kUp, Vec3{-1, 0.9f, 1}, 0.3f, 10) + 20 + 2 * closed_form::kPi;
    });
}

}  // namespace
}  // namespace lumel
