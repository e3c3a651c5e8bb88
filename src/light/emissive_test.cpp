#include "light/emissive.h"

#include <gtest/gtest.h>

#include "support/closed_forms.h"
#include "support/light_checks.h"
#include "support/world_builder.h"

namespace lumel {
namespace {

const Vec3 kA{0, 2, 0}, kB{1.5f, 2.2f, 0.1f}, kC{0.3f, 1.8f, 1.2f};  // seen from below it runs counter-clockwise

Material emitter(bool double_sided) {
    Material material;
    material.emission = {2, 6, 4};
    material.double_sided = double_sided;
    return material;
}

test::World make_world(const Material& material, bool mirrored = false) {
    test::WorldBuilder builder;
    Mesh mesh;
    mesh.positions = {kA, kB, kC};
    mesh.uv0 = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    Affine transform;
    if (mirrored) transform.columns[0] = {-1, 0, 0};
    const std::uint32_t index = builder.add_material(material);
    builder.add_mesh(std::move(mesh), index, transform);
    return builder.build();
}

// Where a ray hits the one triangle of a world.
LightHit meet(const test::World& world, const EmissiveTriangle& triangle, Vec3 origin, Vec3 direction) {
    const auto [a, b, c] = world.geometry.corners(0);
    const Vec3 e1 = b - a, e2 = c - a, p = cross(direction, e2), s = origin - a, q = cross(s, e1);
    const float det = dot(e1, p), b1 = dot(s, p) / det, b2 = dot(direction, q) / det, t = dot(e2, q) / det;
    if (!(b1 >= 0) || !(b2 >= 0) || b1 + b2 > 1 || t <= 0) return {};
    const bool back = dot(direction, world.geometry.geometric_normal(0)) > 0;
    return triangle.hit(b1, b2, direction, t, back);
}

void expect_lambert(const test::World& world, Vec3 point, Vec3 normal, bool reversed) {
    const SurfaceReader surfaces = world.surfaces();
    const EmissiveTriangle triangle(world.scene, world.geometry, surfaces, 0);
    const auto [a, b, c] = world.geometry.corners(0);
    const double expected = reversed ? closed_form::polygon_light(point, normal, {c, b, a}, 6.0)
                                     : closed_form::polygon_light(point, normal, {a, b, c}, 6.0);
    const auto sample = [&](Vec2 u) { return triangle.sample(point, u); };
    const auto hit = [&](Vec3 d) { return meet(world, triangle, point, d); };
    ASSERT_GT(expected, 0.0);
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal), expected, 1e-4, 6));
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, hit, normal), expected, 1e-4, 6));
    test::expect_samples_hit(sample, hit, 1e-4);
}

TEST(EmissiveTriangle, FrontGivesLambertsPolygon) {
    const test::World world = make_world(emitter(false));
    expect_lambert(world, {0.5f, 0.5f, 0.3f}, normalize({0.1f, 1, 0.3f}), false);
}

TEST(EmissiveTriangle, BackOfASingleSidedOneIsDark) {
    const test::World world = make_world(emitter(false));
    const SurfaceReader surfaces = world.surfaces();
    const EmissiveTriangle triangle(world.scene, world.geometry, surfaces, 0);
    const Vec3 above{0.5f, 3, 0.3f};
    EXPECT_EQ(triangle.sample(above, {0.3f, 0.3f}).distance, 0.0f);
    EXPECT_EQ(triangle.hit(0.3f, 0.3f, {0, -1, 0}, 1.0f, true).radiance, Vec3{});
}

TEST(EmissiveTriangle, BackOfADoubleSidedOneEmitsToo) {
    const test::World world = make_world(emitter(true));
    expect_lambert(world, {0.5f, 0.5f, 0.3f}, {0, 1, 0}, false);
    expect_lambert(world, {0.5f, 3, 0.3f}, {0, -1, 0}, true);
}

TEST(EmissiveTriangle, TheFrontOfAMirroredInstanceIsTheMirrorImage) {
    const test::World world = make_world(emitter(false), true);
    expect_lambert(world, {-0.5f, 0.5f, 0.3f}, {0, 1, 0}, true);  // the corners run the other way round
}

TEST(EmissiveTriangle, PowerCountsAreaSidesAndTexture) {
    const test::World one = make_world(emitter(false)), two = make_world(emitter(true));
    const SurfaceReader s1 = one.surfaces(), s2 = two.surfaces();
    const double expected = closed_form::kPi * 4.0 * one.geometry.area(0);  // mean of the channels is 4
    EXPECT_NEAR(EmissiveTriangle(one.scene, one.geometry, s1, 0).power() / expected, 1.0, 1e-6);
    EXPECT_NEAR(EmissiveTriangle(two.scene, two.geometry, s2, 0).power() / (2 * expected), 1.0, 1e-6);
}

// A lamp of 4 x 4 texels in a map of 64 x 64.
test::World textured_world(std::uint32_t lamp_x, std::uint32_t lamp_y) {
    Texture texture;
    texture.width = texture.height = 64;
    texture.rgba.assign(64 * 64 * 4, 0);
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 4; ++x)
            for (std::uint32_t k = 0; k < 3; ++k) texture.rgba[((lamp_y + y) * 64 + lamp_x + x) * 4 + k] = 255;
    test::WorldBuilder builder;
    Material material = emitter(false);
    material.emission_texture.texture = builder.add_texture(texture);
    Mesh mesh;
    mesh.positions = {kA, kB, kC};
    mesh.uv0 = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    const std::uint32_t index = builder.add_material(material);
    builder.add_mesh(std::move(mesh), index);
    return builder.build();
}

TEST(EmissiveTriangle, PowerFindsASmallLampInItsTexture) {
    for (const auto& [x, y] : {std::pair{8u, 8u}, {40u, 3u}, {1u, 50u}, {21u, 29u}}) {
        const test::World world = textured_world(x, y);
        const SurfaceReader surfaces = world.surfaces();
        const double full = closed_form::kPi * 4.0 * world.geometry.area(0);
        const double share = 16.0 / (64 * 32);  // of the triangle's half of the texture
        const double power = EmissiveTriangle(world.scene, world.geometry, surfaces, 0).power();
        // Points are 1.4 to 2 texels apart: good to a factor, which is all that a probability needs.
        EXPECT_GT(power, 0.3 * share * full) << x;
        EXPECT_LT(power, 3.0 * share * full) << x;
    }
}

TEST(EmissiveTriangle, PowerIsNeverZeroWhereTheMaterialEmits) {
    const test::World world = textured_world(50, 50);  // outside the triangle's half of the texture
    const SurfaceReader surfaces = world.surfaces();
    EXPECT_GT(EmissiveTriangle(world.scene, world.geometry, surfaces, 0).power(), 0.0);
}

TEST(EmissiveTriangle, ATexturedOneIsSampledAsItIsMet) {
    const test::World world = textured_world(20, 20);
    const SurfaceReader surfaces = world.surfaces();
    const EmissiveTriangle triangle(world.scene, world.geometry, surfaces, 0);
    const Vec3 point{0.5f, 0.5f, 0.3f}, normal{0, 1, 0};
    const test::Moments light = test::irradiance_by_light([&](Vec2 u) { return triangle.sample(point, u); }, normal);
    const test::Moments rays =
        test::irradiance_by_rays([&](Vec3 d) { return meet(world, triangle, point, d); }, normal);
    EXPECT_GT(light.mean(), 0.0);
    EXPECT_NEAR(light.mean(), rays.mean(),
                test::z_limit(1e-4) * std::hypot(light.standard_error(), rays.standard_error()));
}

TEST(EmissiveTriangle, HolesOfAnAlphaMaskEmitNothing) {
    Texture texture;  // left half transparent
    texture.width = 2, texture.height = 1;
    texture.rgba = {255, 255, 255, 0, 255, 255, 255, 255};
    test::WorldBuilder builder;
    Material material = emitter(false);
    material.base_color_texture.texture = builder.add_texture(texture);
    material.base_color_texture.nearest = true;
    material.alpha_mode = AlphaMode::mask;
    Mesh mesh;
    mesh.positions = {kA, kB, kC};
    mesh.uv0 = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    const std::uint32_t index = builder.add_material(material);
    builder.add_mesh(std::move(mesh), index);
    const test::World world = builder.build();
    const SurfaceReader surfaces = world.surfaces();
    const EmissiveTriangle triangle(world.scene, world.geometry, surfaces, 0);
    // The opaque part is where the first barycentric, u, exceeds a half.
    const Vec3 middle = (kA + kB) * 0.5f, edge = kA + (kB - kA) * 0.5f + (kC - kA) * 0.5f;
    const Vec3 point{0.5f, 0.5f, 0.3f}, normal{0, 1, 0};
    const double expected = closed_form::polygon_light(point, normal, {middle, kB, edge}, 6.0);
    const auto sample = [&](Vec2 u) { return triangle.sample(point, u); };
    EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal), expected, 1e-4));
}

}  // namespace
}  // namespace lumel
