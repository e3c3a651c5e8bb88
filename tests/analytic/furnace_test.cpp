// White furnaces: closed boxes in which every surface sends out the same radiance, so that every texel must have it.
#include <gtest/gtest.h>

#include "baked_page.h"

namespace lumel {
namespace {

constexpr double kMeanTolerance = 0.001;

Scene furnace(test::SceneBuilder& builder, std::uint32_t material) {
    builder.object("box", material, [](Mesh& mesh) { test::add_box(mesh, {-1, 0, -0.5f}, {1, 1.5f, 0.5f}, true); });
    return builder.build();
}

BakeOptions options() {
    BakeOptions options;
    options.uv1 = Uv1Choice::ignore;
    options.texels_per_metre = 10;
    options.samples = 512;
    return options;
}

// Radiance e + rho e + rho^2 e ... = e / (1 - rho): for albedo 0.5 and emission 1 it is 2; red is that, the others are
// chosen to give 1.25 and 5.
TEST(Furnace, ConstantAlbedo) {
    test::SceneBuilder builder;
    const auto texels = test::bake_texels(furnace(builder, builder.material({0.5f, 0.2f, 0.8f}, {1, 1, 1})), options());
    ASSERT_GT(texels.size(), 1000u);
    test::expect_texels(
        texels,
        [](const test::BakedTexel&) {
            return std::array<double, 3>{2.0, 1.25, 5.0};
        },
        kMeanTolerance);
    // What comes straight from an emitter is the emission; the rest has bounced.
    double direct = 0, sky = 0;
    for (const test::BakedTexel& texel : texels) {
        direct += texel.layers[static_cast<std::size_t>(Layer::direct)].x;
        sky += texel.layers[static_cast<std::size_t>(Layer::sky)].x;
    }
    EXPECT_NEAR(direct / static_cast<double>(texels.size()), 1.0, kMeanTolerance);
    EXPECT_EQ(sky, 0.0);  // the box is closed
}

// Albedo rho(u, v) and emission 1 - rho: radiance 1 everywhere, however rho varies.
TEST(Furnace, TexturedAlbedo) {
    test::Random random(1);
    Texture albedo;
    albedo.width = albedo.height = 16;
    albedo.srgb = false;
    for (int i = 0; i < 16 * 16; ++i) {
        for (int c = 0; c < 3; ++c) albedo.rgba.push_back(static_cast<std::uint8_t>(20 + random.bits() % 200));
        albedo.rgba.push_back(255);
    }
    Texture emission = albedo;
    for (std::size_t i = 0; i < emission.rgba.size(); ++i)
        if (i % 4 != 3) emission.rgba[i] = static_cast<std::uint8_t>(255 - emission.rgba[i]);

    test::SceneBuilder builder;
    const std::uint32_t material = builder.material({1, 1, 1}, {1, 1, 1});
    builder.material_at(material).base_color_texture.texture = builder.texture(albedo);
    builder.material_at(material).emission_texture.texture = builder.texture(emission);
    const auto texels = test::bake_texels(furnace(builder, material), options());
    ASSERT_GT(texels.size(), 1000u);
    test::expect_texels(
        texels,
        [](const test::BakedTexel&) {
            return std::array<double, 3>{1, 1, 1};
        },
        kMeanTolerance);
}

// The same light from outside: a box in a uniform sky that reflects everything hides itself.
TEST(Furnace, AWhiteBoxInAWhiteSky) {
    test::SceneBuilder builder;
    builder.object("box", builder.material({1, 1, 1}), [](Mesh& mesh) {
        test::add_box(mesh, {-1, 0, -0.5f}, {1, 1.5f, 0.5f}, false);
    });
    builder.object(
        "slab", builder.material({1, 1, 1}),
        [](Mesh& mesh) {
            test::add_box(mesh, {-2, -0.5f, -2}, {2, -0.2f, 2}, false);
        },
        {}, NodeClass::volume);
    builder.scene().sky.color = {1, 2, 3};
    const auto texels = test::bake_texels(builder.build(), options());
    ASSERT_GT(texels.size(), 1000u);
    test::expect_texels(
        texels,
        [](const test::BakedTexel&) {
            return std::array<double, 3>{1, 2, 3};
        },
        kMeanTolerance);
}

}  // namespace
}  // namespace lumel
