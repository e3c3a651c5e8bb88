// The hemisphere of a texel (docs/conventions.md): where its rays may go, and what its light is divided by.
#include <gtest/gtest.h>

#include <cmath>

#include "baked_page.h"
#include "math/constants.h"

namespace lumel {
namespace {

// A sphere of 2 m seen from inside, smooth-shaded, closed but coarse: 12 x 8 segments.
void add_hollow_sphere(Mesh& mesh) {
    constexpr std::uint32_t kAround = 12, kDown = 8;
    for (std::uint32_t v = 0; v <= kDown; ++v)
        for (std::uint32_t u = 0; u <= kAround; ++u) {
            const double phi = 2.0 * 3.14159265358979 * (u % kAround) / kAround, theta = 3.14159265358979 * v / kDown;
            const double sine = v == 0 || v == kDown ? 0.0 : std::sin(theta);
            const Vec3 n{static_cast<float>(sine * std::cos(phi)), static_cast<float>(std::cos(theta)),
                         static_cast<float>(sine * std::sin(phi))};
            mesh.positions.push_back(n * 2.0f);
            mesh.normals.push_back(-n);
            mesh.uv0.push_back({});
        }
    const auto at = [](std::uint32_t u, std::uint32_t v) { return v * (kAround + 1) + u; };
    for (std::uint32_t v = 0; v < kDown; ++v)
        for (std::uint32_t u = 0; u < kAround; ++u) {
            if (v > 0) mesh.triangles.push_back({at(u, v), at(u, v + 1), at(u + 1, v)});
            if (v + 1 < kDown) mesh.triangles.push_back({at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)});
        }
}

// The vertex normal's hemisphere reaches below the facets. Rays that go there meet the facet they start on; they must
// not leave through it. The orientation of the triangles is checked by the count: seen from behind, none is valid.
TEST(Hemisphere, NoLightEntersAClosedSmoothHollow) {
    test::SceneBuilder builder;
    builder.object("hollow", builder.material({0.5f, 0.5f, 0.5f}), add_hollow_sphere);
    Light& sun = builder.light(LightShape::sun);
    sun.direction = normalize(Vec3{0.3f, -1.0f, 0.2f});
    sun.intensity = {1000, 1000, 1000};
    BakeOptions options;
    options.texels_per_metre = 6;
    options.samples = 64;
    options.sky.color = Vec3{1, 1, 1};
    Scene scene = builder.build();
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    const auto texels = test::bake_texels(scene, options);
    ASSERT_GT(texels.size(), 1000u);
    for (const test::BakedTexel& texel : texels) ASSERT_EQ(texel.irradiance, Vec3{}) << texel.x << " " << texel.y;
}

// Half of what this floor could see is the back of a wall, black. The same even sky, once met by rays alone and
// once as a map, sampled by both ways, must light it alike.
TEST(Hemisphere, BothWaysToSampleTheSkyAgreeBesideABack) {
    const auto mean = [](bool as_map) {
        test::SceneBuilder builder;
        const std::uint32_t grey = builder.material({0.5f, 0.5f, 0.5f});
        builder.object("floor", grey, [](Mesh& mesh) { test::add_quad(mesh, {-2, 0, 2}, {2, 0, 0}, {0, 0, -4}); });
        builder.object(
            "wall", grey,
            [](Mesh& mesh) {
                test::add_quad(mesh, {0, 0, 200}, {0, 0, -400}, {0, 20, 0});
            },
            {}, NodeClass::occluder);
        Scene scene = builder.build();
        if (as_map) {
            scene.sky.map = SkyMap{16, 8, std::vector<Vec3>(16 * 8, Vec3{1, 1, 1})};
        } else {
            scene.sky.color = {1, 1, 1};
        }
        BakeOptions options;
        options.texels_per_metre = 8;
        options.samples = 1024;
        const auto texels = test::bake_texels(scene, options);
        double sum = 0.0;
        for (const test::BakedTexel& texel : texels) sum += texel.irradiance.x;
        return sum / static_cast<double>(texels.size());
    };
    const double by_rays = mean(false), by_both = mean(true);
    // At distance d from a long wall of height h a floor sees (1 + d / sqrt(d^2 + h^2)) / 2 of the sky, on average over
    // the 2 m 1/2 + (sqrt(404) - 20) / 4. The wall ends 200 m to either side, which is 1e-3 of it, and the texels at
    // its foot may be invalid and take the light of the next.
    EXPECT_NEAR(by_rays, 0.5 + (std::sqrt(404.0) - 20.0) / 4.0, 3e-3);
    // Some 500 texels of 1024 samples, each within a few percent: the means are good to some 1e-4.
    EXPECT_NEAR(by_both / by_rays, 1.0, 2e-3);
}

// A sun that stands on this side of the wall lights the floor before its back as if the wall were not there.
TEST(Hemisphere, TheBackOfAWallDoesNotBrightenTheSun) {
    test::SceneBuilder builder;
    const std::uint32_t grey = builder.material({0.5f, 0.5f, 0.5f});
    builder.object("floor", grey, [](Mesh& mesh) { test::add_quad(mesh, {-2, 0, 1}, {2, 0, 0}, {0, 0, -2}); });
    builder.object(
        "wall", grey,
        [](Mesh& mesh) {
            test::add_quad(mesh, {0, 0, 3}, {0, 0, -6}, {0, 2, 0});
        },
        {}, NodeClass::occluder);
    Light& sun = builder.light(LightShape::sun);
    sun.direction = normalize(Vec3{1, -1, 0});
    sun.intensity = {3, 3, 3};
    BakeOptions options;
    options.texels_per_metre = 4;
    options.samples = 64;
    options.bounces = 0;
    const Scene scene = builder.build();
    const auto texels = test::bake_texels(scene, options);
    ASSERT_GT(texels.size(), 60u);
    const float expected = 3.0f * std::sqrt(0.5f) * kInvPi;
    for (const test::BakedTexel& texel : texels) ASSERT_NEAR(texel.irradiance.x, expected, 1e-5f * expected);
}

// Light that a ray meets before it meets a back: the ray's share of it must not be lost. Lamps that hang below a cover
// whose back is seen light the floor as below a cover that is black on both sides; two of them, so that a light sample
// has half of the chance, and what the rays bring has the more weight.
TEST(Hemisphere, ALampBeforeABackKeepsAllItsLight) {
    const auto mean = [](bool double_sided) {
        test::SceneBuilder builder;
        builder.object("floor", builder.material({0.5f, 0.5f, 0.5f}), [](Mesh& mesh) {
            test::add_quad(mesh, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1});
        });
        builder.object(
            "cover", builder.material({0, 0, 0}, {}, double_sided),
            [](Mesh& mesh) {
                test::add_quad(mesh, {-1, 1.01f, 0.5f}, {2, 0, 0}, {0, 0, -1});
            },
            {}, NodeClass::occluder);
        for (const float side : {-0.5f, 0.5f}) {
            Light& lamp = builder.light(LightShape::rectangle);
            lamp.position = {side, 1.0f, 0};
            lamp.direction = {0, -1, 0};
            lamp.half_u = {0.45f, 0, 0};
            lamp.half_v = {0, 0, 0.45f};
            lamp.intensity = {2, 2, 2};
        }
        BakeOptions options;
        options.texels_per_metre = 12;
        options.samples = 256;
        options.bounces = 0;
        const auto texels = test::bake_texels(builder.build(), options);
        EXPECT_GT(texels.size(), 100u);
        double sum = 0.0;
        for (const test::BakedTexel& texel : texels) sum += texel.irradiance.x;
        return sum / static_cast<double>(std::max<std::size_t>(1, texels.size()));
    };
    const double black = mean(true), back = mean(false);
    EXPECT_GT(black, 0.1);
    // More than a hundred texels of 256 samples, each within a few percent.
    EXPECT_NEAR(back / black, 1.0, 3e-3);
}

// A wall further than --ao-distance does not occlude, whichever side of it is seen.
TEST(Hemisphere, AFarBackDoesNotOcclude) {
    test::SceneBuilder builder;
    const std::uint32_t grey = builder.material({0.5f, 0.5f, 0.5f});
    builder.object("floor", grey, [](Mesh& mesh) { test::add_quad(mesh, {-4, 0, 1}, {2, 0, 0}, {0, 0, -2}); });
    builder.object(
        "wall", grey,
        [](Mesh& mesh) {
            test::add_quad(mesh, {0, 0, 9}, {0, 0, -18}, {0, 9, 0});
        },
        {}, NodeClass::occluder);
    builder.scene().sky.color = {1, 1, 1};
    BakeOptions options;
    options.texels_per_metre = 4;
    options.samples = 64;
    options.ao_distance = 1.0;
    const auto texels = test::bake_texels(builder.build(), options);
    ASSERT_GT(texels.size(), 40u);
    double sum = 0.0;
    for (const test::BakedTexel& texel : texels) sum += static_cast<double>(texel.ambient_occlusion);
    // At 1 the noise is cut off, a twentieth for a texel of 64 samples. Were backs in the way, it would be some 0.6.
    EXPECT_GT(sum / static_cast<double>(texels.size()), 0.97);
}

// With --two-sided the lid of a crate has the light of its outside: inside there is nothing but backs.
TEST(Hemisphere, ALidHasOneSide) {
    test::SceneBuilder builder;
    builder.object(
        "crate", builder.material({0.5f, 0.5f, 0.5f}),
        [](Mesh& mesh) {  // open above
            const Vec3 low{-0.5f, 0, -0.5f}, x{1, 0, 0}, y{0, 0.8f, 0}, z{0, 0, 1};
            test::add_quad(mesh, low, x, z);
            test::add_quad(mesh, low, y, x);
            test::add_quad(mesh, low + z, x, y);
            test::add_quad(mesh, low, z, y);
            test::add_quad(mesh, low + x, y, z);
        },
        {}, NodeClass::occluder);
    builder.object("lid", builder.material({0.5f, 0.5f, 0.5f}, {}, true), [](Mesh& mesh) {
        test::add_quad(mesh, {-0.5f, 0.8f, 0.5f}, {1, 0, 0}, {0, 0, -1});
    });
    builder.scene().sky.color = {1, 1, 1};
    BakeOptions options;
    options.texels_per_metre = 8;
    options.samples = 128;
    options.two_sided = true;
    const auto texels = test::bake_texels(builder.build(), options);
    ASSERT_GT(texels.size(), 20u);
    double sum = 0.0;
    for (const test::BakedTexel& texel : texels) sum += texel.irradiance.x;
    EXPECT_NEAR(sum / static_cast<double>(texels.size()), 1.0, 0.02);
}

// Twice the direct light has twice its standard error; light that the files leave out has no part in it.
TEST(Hemisphere, TheStatedErrorFollowsScalesAndInclude) {
    const auto error = [](float direct_scale, bool indirect) {
        test::SceneBuilder builder;
        builder.object("box", builder.material({0.5f, 0.5f, 0.5f}, {1, 1, 1}), [](Mesh& mesh) {
            test::add_box(mesh, {-1, 0, -1}, {1, 1, 1}, true);
        });
        builder.object("lid", builder.material({0.1f, 0.9f, 0.5f}), [](Mesh& mesh) {
            test::add_box(mesh, {-0.5f, 0.2f, -0.5f}, {0.5f, 0.5f, 0.5f}, false);
        });
        BakeOptions options;
        options.texels_per_metre = 4;
        options.samples = 64;
        options.direct_scale = direct_scale;
        options.include.indirect = indirect;
        const auto texels = test::bake_texels(builder.build(), options);
        double sum = 0.0;
        for (const test::BakedTexel& texel : texels) sum += static_cast<double>(texel.error.x);
        return sum / static_cast<double>(texels.size());
    };
    EXPECT_NEAR(error(10, false) / error(1, false), 10.0, 1e-3);
    EXPECT_GT(error(1, true), 1.05 * error(1, false));
}

}  // namespace
}  // namespace lumel
