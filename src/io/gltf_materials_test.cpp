// Materials and textures from glTF made in code.
#include "io/gltf_materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include <fstream>

#include "io/image_io.h"
#include "scene/surface.h"
#include "support/load_gltf.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;
using Json = GltfBuilder::Json;

// 2 x 2 pixels: red, green / blue, white.
std::vector<std::byte> four_colours() {
    const std::vector<std::uint8_t> pixels{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 128};
    return encode_png(2, 2, 4, pixels);
}

// A triangle whose material is `material`; image 0 and texture 0 are four_colours().
GltfBuilder with_material(Json material) {
    GltfBuilder builder;
    builder.triangle_node();
    builder.add("images", {{"bufferView", builder.view(four_colours())}, {"mimeType", "image/png"}});
    builder.add("textures", {{"source", 0}});
    builder.add("materials", std::move(material));
    builder.root["meshes"][0]["primitives"][0]["material"] = 0;
    return builder;
}

Json textured(Json info = Json::object()) {
    info["index"] = 0;
    return {{"pbrMetallicRoughness", {{"baseColorTexture", std::move(info)}}}};
}

TEST(GltfMaterials, ReadsFactorsAndFlags) {
    const Loaded loaded(with_material({{"name", "paint"},
                                       {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}}},
                                       {"emissiveFactor", {0.5, 1, 0}},
                                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}},
                                       {"alphaMode", "MASK"},
                                       {"alphaCutoff", 0.25},
                                       {"doubleSided", true}}));
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const Material& material = loaded.scene().materials[0];
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.base_color, (Vec3{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(material.alpha, 0.4f);
    EXPECT_EQ(material.emission, (Vec3{4, 8, 0}));
    EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(material.alpha_cutoff, 0.25f);
    EXPECT_TRUE(material.double_sided);
    ASSERT_EQ(loaded.scene().materials.size(), 2u) << "the default material is the last";
    EXPECT_EQ(loaded.scene().materials[1].base_color, (Vec3{1, 1, 1}));
    EXPECT_TRUE(loaded.scene().textures.empty()) << "nobody uses the image";
}

TEST(GltfMaterials, DecodesEmbeddedPngOnce) {
    Json material = textured();
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
    const Loaded loaded(with_material(material));
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    ASSERT_EQ(loaded.scene().textures.size(), 1u);
    const Texture& texture = loaded.scene().textures[0];
    EXPECT_EQ(texture.width, 2u);
    EXPECT_TRUE(texture.srgb);
    EXPECT_EQ(texture.rgba[4 + 1], 255) << "second pixel of row 0 is green";
    EXPECT_EQ(texture.rgba[15], 128);
    EXPECT_EQ(loaded.scene().materials[0].emission_texture.uv_set, 1);
}

TEST(GltfMaterials, BlackEmissionNeedsNoTexture) {
    const Loaded loaded(with_material({{"emissiveTexture", {{"index", 99}}}}));
    EXPECT_TRUE(loaded.result.ok()) << loaded.error();
}

TEST(GltfMaterials, ReadsSamplers) {
    GltfBuilder builder = with_material(textured());
    builder.root["textures"][0]["sampler"] = 0;
    builder.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    const Loaded loaded(builder);
    const TextureRef& ref = loaded.scene().materials[0].base_color_texture;
    EXPECT_EQ(ref.wrap_u, Wrap::clamp);
    EXPECT_EQ(ref.wrap_v, Wrap::mirror);
    EXPECT_TRUE(ref.nearest);
    builder.root["samplers"][0]["wrapS"] = 5;
    EXPECT_TRUE(Loaded(builder).error_says("'wrapS' is 5"));
}

// The extension's example, a quarter turn counter-clockwise: what lies at u = x of the turned picture comes from v.
TEST(GltfMaterials, AppliesTextureTransforms) {
    const auto transform = [](Json json) {
        const Loaded loaded(with_material(textured({{"extensions", {{"KHR_texture_transform", std::move(json)}}}})));
        EXPECT_TRUE(loaded.result.ok()) << loaded.error();
        return loaded.scene().materials[0].base_color_texture.transform;
    };
    const auto apply = [](const std::array<float, 6>& m, Vec2 uv) {
        return Vec2{m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
    };
    const Vec2 moved = apply(transform({{"offset", {0.25, 0.5}}, {"scale", {2, 4}}}), {0.1f, 0.1f});
    EXPECT_FLOAT_EQ(moved.x, 0.45f);
    EXPECT_FLOAT_EQ(moved.y, 0.9f);
    // three.js, Matrix3.setUvTransform: u' = c u + s v, v' = -s u + c v.
    const Vec2 turned = apply(transform({{"rotation", 1.5707963267948966}}), {1.0f, 0.25f});
    EXPECT_NEAR(turned.x, 0.25f, 1e-6f);
    EXPECT_NEAR(turned.y, -1.0f, 1e-6f);
    // Any number of turns is an angle: a million of them and a quarter are a quarter, to the digits that 6e6 leaves.
    const Vec2 turned_often =
        apply(transform({{"rotation", 6283185.30717958648 + 1.57079632679489662}}), {1.0f, 0.25f});
    EXPECT_NEAR(turned_often.x, 0.25f, 1e-6f);
    EXPECT_NEAR(turned_often.y, -1.0f, 1e-6f);
    for (const float number : transform({{"rotation", 1e30}})) EXPECT_LE(std::fabs(number), 1.0f);
    // Scale first, then rotation, then offset.
    const Vec2 all =
        apply(transform({{"rotation", 1.5707963267948966}, {"scale", {2, 3}}, {"offset", {5, 7}}}), {1.0f, 1.0f});
    EXPECT_NEAR(all.x, 5.0f + 3.0f, 1e-5f);
    EXPECT_NEAR(all.y, 7.0f - 2.0f, 1e-5f);
}

TEST(GltfMaterials, TheTransformsTexCoordWins) {
    const Loaded loaded(
        with_material(textured({{"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}})));
    EXPECT_EQ(loaded.scene().materials[0].base_color_texture.uv_set, 1);
    EXPECT_TRUE(Loaded(with_material(textured({{"texCoord", 2}}))).error_says("TEXCOORD_2"));
}

TEST(GltfMaterials, NamesAMissingTextureFileItsUserAndTheRemedy) {
    test::TemporaryFolder folder;
    GltfBuilder builder = with_material(textured());
    builder.root["materials"][0]["name"] = "wood";
    builder.root["images"][0] = {{"uri", "gone.png"}};
    const auto glb = builder.glb();
    std::ofstream(folder / "room.glb", std::ios::binary)
        .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
    Context context(1);
    const auto loaded = load_scene(folder / "room.glb", context);
    ASSERT_FALSE(loaded.ok());
    const std::string text = loaded.error().text();
    EXPECT_EQ(loaded.error().code, ErrorCode::io);
    for (const char* part : {"room.glb", "gone.png", "material 0 'wood'", "baseColorTexture", "beside the scene"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

TEST(GltfMaterials, ReadsExternalTextures) {
    test::TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder / "a b.png", four_colours()).ok());
    GltfBuilder builder = with_material(textured());
    builder.root["images"][0] = {{"uri", "a%20b.png"}};
    ASSERT_TRUE(write_file(folder / "room.glb", builder.glb()).ok());
    Context context(1);
    const auto loaded = load_scene(folder / "room.glb", context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    EXPECT_EQ(loaded->scene.textures.size(), 1u);
}

TEST(GltfMaterials, UnusedMaterialsNeedNoFiles) {
    GltfBuilder builder = with_material(Json::object());
    builder.add("materials", textured());
    builder.root["images"][0] = {{"uri", "gone.png"}};
    const Loaded loaded(builder);
    EXPECT_TRUE(loaded.result.ok()) << loaded.error();
}

TEST(GltfMaterials, RefusesTexturesAbove8192) {
    GltfBuilder builder = with_material(textured());
    builder.root["images"][0]["bufferView"] = builder.view(encode_png(8193, 1, 1, std::vector<std::uint8_t>(8193)));
    const Loaded loaded(builder);
    EXPECT_TRUE(loaded.error_says("8193 x 1 pixels")) << loaded.error();
    EXPECT_TRUE(loaded.error_says("8192")) << loaded.error();
    EXPECT_TRUE(loaded.error_says("image 0")) << loaded.error();
}

TEST(GltfMaterials, RefusesTruncatedImages) {
    std::vector<std::byte> png = four_colours();
    png.resize(png.size() / 2);
    GltfBuilder builder = with_material(textured());
    builder.root["images"][0]["bufferView"] = builder.view(png);
    EXPECT_TRUE(Loaded(builder).error_says("cannot be decoded")) << Loaded(builder).error();
}

TEST(GltfMaterials, ForeignFormatsNeedAFallback) {
    GltfBuilder builder = with_material(textured());
    builder.root["textures"][0]["extensions"]["KHR_texture_basisu"] = {{"source", 7}};
    EXPECT_TRUE(Loaded(builder).result.ok()) << "the fallback is used";
    builder.root["textures"][0].erase("source");
    EXPECT_TRUE(Loaded(builder).error_says("KHR_texture_basisu"));
    EXPECT_TRUE(Loaded(builder).error_says("PNG or JPEG"));
}

TEST(GltfMaterials, SaysWhatItLeavesOut) {
    const Loaded loaded(with_material({{"extensions",
                                        {{"KHR_materials_diffuse_transmission", Json::object()},
                                         {"KHR_materials_clearcoat", Json::object()},
                                         {"KHR_materials_unlit", Json::object()}}}}));
    EXPECT_EQ(loaded.notes("diffuse-transmission"), 1u);
    EXPECT_EQ(loaded.notes("ignored-extension"), 1u);
    EXPECT_EQ(loaded.notes("unlit-material"), 1u);
}

TEST(GltfMaterials, ClampsColoursAndSaysSo) {
    const Loaded loaded(with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1.5, 0.5, -1, 1}}}}}));
    EXPECT_EQ(loaded.scene().materials[0].base_color, (Vec3{1, 0.5f, 0}));
    EXPECT_EQ(loaded.notes("clamped-factor"), 2u);
}

TEST(GltfMaterials, RefusesNonsense) {
    EXPECT_TRUE(Loaded(with_material({{"emissiveFactor", {-1, 0, 0}}})).error_says("emission"));
    EXPECT_TRUE(Loaded(with_material({{"alphaMode", "GLOW"}})).error_says("GLOW"));
    EXPECT_TRUE(Loaded(with_material({{"doubleSided", 1}})).error_says("'doubleSided' must be true or false"));
    EXPECT_TRUE(Loaded(with_material({{"pbrMetallicRoughness", 3}})).error_says("must be an object"));
    EXPECT_TRUE(Loaded(with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 4}}}}}}))
                    .error_says("textures[4]"));
}

TEST(GltfMaterials, TakesSpecularGlossinessAsDiffuse) {
    const Loaded loaded(
        with_material({{"extensions",
                        {{"KHR_materials_pbrSpecularGlossiness",
                          {{"diffuseFactor", {0.2, 0.3, 0.4, 1}}, {"diffuseTexture", {{"index", 0}}}}}}}}));
    EXPECT_EQ(loaded.scene().materials[0].base_color, (Vec3{0.2f, 0.3f, 0.4f}));
    EXPECT_EQ(loaded.scene().materials[0].base_color_texture.texture, 0u);
}

}  // namespace
}  // namespace lumel
