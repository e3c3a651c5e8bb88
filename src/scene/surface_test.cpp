// Texture filtering and materials against values worked out by hand.
#include "scene/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scene_builder.h"

namespace lumel {
namespace {

using test::SceneBuilder;

// Four texels in a row: 0, 255, 0, 0 in red; alpha 255.
Texture red_stripe(bool srgb) {
    Texture texture{"stripe", 4, 1, srgb, std::vector<std::uint8_t>(16, 0)};
    texture.rgba[4] = 255;
    for (std::size_t i = 3; i < 16; i += 4) texture.rgba[i] = 255;
    return texture;
}

Texture grey(std::uint8_t value, bool srgb) { return {"grey", 1, 1, srgb, {value, value, value, value}}; }

TEST(SampleTexture, DecodesEverySrgbByteAsTheStandardDoes) {
    for (int byte = 0; byte < 256; ++byte) {
        const double s = byte / 255.0;
        const double expected = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        const Vec4 texel = sample_texture(grey(static_cast<std::uint8_t>(byte), true), {}, {0.5f, 0.5f});
        // Half an ulp of float for the table, as much again for the bilinear sum of four equal texels.
        EXPECT_NEAR(texel.x, expected, 1.2e-7) << byte;
        EXPECT_NEAR(texel.w, s, 1.2e-7) << "alpha is never gamma coded";
    }
}

TEST(SampleTexture, LinearTexturesAreNotDecoded) {
    EXPECT_NEAR(sample_texture(grey(128, false), {}, {0, 0}).x, 128.0f / 255.0f, 1.2e-7f);
}

TEST(SampleTexture, IsExactAtTexelCentresAndLinearBetween) {
    const Texture texture = red_stripe(false);
    TextureRef ref;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.375f, 0.5f}).x, 1.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.125f, 0.5f}).x, 0.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.25f, 0.5f}).x, 0.5f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.3125f, 0.5f}).x, 0.75f);
}

TEST(SampleTexture, RowZeroIsAtTheTop) {
    Texture texture{"rows", 1, 2, false, {255, 0, 0, 255, 0, 0, 0, 255}};
    EXPECT_FLOAT_EQ(sample_texture(texture, {}, {0.5f, 0.25f}).x, 1.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, {}, {0.5f, 0.75f}).x, 0.0f);
}

TEST(SampleTexture, WrapsAsTheSamplerSays) {
    const Texture texture = red_stripe(false);
    TextureRef ref;
    ref.nearest = true;
    ref.wrap_u = Wrap::repeat;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {-0.625f, 0}).x, 1.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {7.375f, 0}).x, 1.0f);
    ref.wrap_u = Wrap::mirror;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {-0.375f, 0}).x, 1.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {1.625f, 0}).x, 1.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {1.375f, 0}).x, 0.0f);
    ref.wrap_u = Wrap::clamp;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {-0.625f, 0}).x, 0.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {1.375f, 0}).x, 0.0f);
}

TEST(SampleTexture, FiltersAcrossTheBorderOnlyWhereItRepeats) {
    Texture texture{"ends", 2, 1, false, {255, 0, 0, 255, 0, 0, 0, 255}};
    TextureRef ref;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.0f, 0.5f}).x, 0.5f);
    ref.wrap_u = Wrap::clamp;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.0f, 0.5f}).x, 1.0f);
    ref.wrap_u = Wrap::mirror;
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.0f, 0.5f}).x, 1.0f);
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {1.0f, 0.5f}).x, 0.0f);
}

TEST(SampleTexture, AppliesTheTransform) {
    const Texture texture = red_stripe(false);
    TextureRef ref;
    ref.transform = {0, 1, 0.25f, 1, 0, 0};  // u' = v + 0.25
    EXPECT_FLOAT_EQ(sample_texture(texture, ref, {0.9f, 0.125f}).x, 1.0f);
}

TEST(SampleTexture, SurvivesAnyCoordinate) {
    const Texture texture = red_stripe(false);
    const float infinity = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const float u : {1e30f, -1e30f, infinity, -infinity, std::nanf(""), -1e-30f, 0.99999997f}) {
            TextureRef ref;
            ref.wrap_u = ref.wrap_v = wrap;
            const float bilinear = sample_texture(texture, ref, {u, u}).x;
            ref.nearest = true;
            const float nearest = sample_texture(texture, ref, {u, u}).x;
            EXPECT_TRUE(bilinear >= 0.0f && bilinear <= 1.0f && nearest >= 0.0f && nearest <= 1.0f) << u;
        }
}

// One quad with all that a base colour is made of.
struct QuadScene {
    Scene scene;
    WorldGeometry geometry;

    template <class Edit>
    explicit QuadScene(Edit&& edit, NodeClass node_class = NodeClass::lightmap) {
        SceneBuilder builder;
        const std::uint32_t material = builder.material({0.5f, 1.0f, 0.25f});
        builder.object(
            "quad", material,
            [](Mesh& mesh) {
                test::add_quad(mesh, {}, {1, 0, 0}, {0, 1, 0});
                mesh.colors.assign(4, {0.5f, 0.5f, 0.5f, 0.5f});
            },
            {}, node_class);
        edit(builder, builder.material_at(material));
        scene = builder.build();
        Context context(1);
        geometry = std::move(flatten(scene, context)).value();
    }
    [[nodiscard]] SurfaceReader reader() const { return {scene, geometry}; }
};

TEST(SurfaceReader, MultipliesFactorTextureAndVertexColour) {
    const QuadScene quad([](SceneBuilder& builder, Material& material) {
        material.base_color_texture.texture = builder.texture({"t", 1, 1, false, {255, 51, 255, 255}});
    });
    const Vec3 albedo = quad.reader().albedo(0, 0.2f, 0.3f);
    EXPECT_FLOAT_EQ(albedo.x, 0.25f);
    EXPECT_FLOAT_EQ(albedo.y, 0.1f);
    EXPECT_FLOAT_EQ(albedo.z, 0.125f);
}

TEST(SurfaceReader, InterpolatesUvByBarycentrics) {
    // Corner k of triangle 0 has uv (0,0), (1,0), (1,1): red grows with b1 + b2 in a two-texel ramp's middle.
    const QuadScene quad([](SceneBuilder& builder, Material& material) {
        material.base_color_texture.texture =
            builder.texture({"ramp", 2, 1, false, {0, 0, 0, 255, 255, 255, 255, 255}});
        material.base_color_texture.wrap_u = Wrap::clamp;
    });
    // u = 0.5 lies between the centres 0.25 and 0.75 of the two texels.
    EXPECT_NEAR(quad.reader().albedo(0, 0.5f, 0.0f).x, 0.5f * 0.5f * 0.5f, 1e-6f);
    EXPECT_NEAR(quad.reader().albedo(0, 0.0f, 0.625f).x, 0.75f * 0.25f, 1e-6f);
}

TEST(SurfaceReader, OccludersReflectAndEmitNothing) {
    const QuadScene quad([](SceneBuilder&, Material& material) { material.emission = {9, 9, 9}; }, NodeClass::occluder);
    EXPECT_EQ(quad.reader().albedo(0, 0.2f, 0.3f), Vec3{});
    EXPECT_EQ(quad.reader().emission(0, 0.2f, 0.3f), Vec3{});
    EXPECT_EQ(quad.reader().opacity(0, 0.2f, 0.3f), 1.0f);
}

TEST(SurfaceReader, EmissionIsFactorTimesTexture) {
    const QuadScene quad([](SceneBuilder& builder, Material& material) {
        material.emission = {10, 20, 30};
        material.emission_texture.texture = builder.texture({"t", 1, 1, false, {255, 0, 51, 0}});
    });
    const Vec3 emission = quad.reader().emission(1, 0.1f, 0.1f);
    EXPECT_FLOAT_EQ(emission.x, 10.0f);
    EXPECT_FLOAT_EQ(emission.y, 0.0f);
    EXPECT_FLOAT_EQ(emission.z, 6.0f);
}

TEST(SurfaceReader, OpacityFollowsTheAlphaMode) {
    // Vertex alpha is 0.5, material alpha 0.8: 0.4 in all.
    const auto opacity = [](AlphaMode mode, float cutoff) {
        const QuadScene quad([&](SceneBuilder&, Material& material) {
            material.alpha = 0.8f;
            material.alpha_mode = mode;
            material.alpha_cutoff = cutoff;
        });
        return quad.reader().opacity(0, 0.25f, 0.25f);
    };
    EXPECT_FLOAT_EQ(opacity(AlphaMode::opaque, 0.5f), 1.0f);
    EXPECT_FLOAT_EQ(opacity(AlphaMode::mask, 0.5f), 0.0f);
    EXPECT_FLOAT_EQ(opacity(AlphaMode::mask, 0.3f), 1.0f);
    EXPECT_FLOAT_EQ(opacity(AlphaMode::blend, 0.5f), 0.4f);
}

}  // namespace
}  // namespace lumel
