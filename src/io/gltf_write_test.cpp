// Scenes made in code go through charts and atlas and come back from the written file: by our own reader, corner by
// corner, and by looking at its JSON.
#include "io/gltf_write.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "io/baked.h"
#include "io/gltf_accessor.h"
#include "io/gltf_container.h"
#include "io/image_io.h"
#include "support/load_gltf.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;
using test::TemporaryFolder;

LitTexture grey_page(const AtlasPage& size, float strength = 2.5f) {
    const std::vector<std::uint8_t> pixels(std::size_t{size.width} * size.height * 3, 128);
    return {encode_png(size.width, size.height, 3, pixels), strength};
}

// A scene, its layout and what was written.
struct Written {
    Loaded loaded;
    WorldGeometry geometry;
    ChartSet charts;
    Atlas atlas;
    TemporaryFolder folder;
    GltfDocumentPtr document;  // of the written file

    explicit Written(const GltfBuilder& builder, const ChartOptions& options = default_options(),
                     const Include& include = {})
        : loaded(builder) {
        if (!loaded.result.ok()) {
            ADD_FAILURE() << loaded.error();
            return;
        }
        write(options, include);
    }

    static ChartOptions default_options() {
        ChartOptions options;
        options.texels_per_metre = 16;
        options.max_page = 256;
        return options;
    }

    [[nodiscard]] const Scene& scene() const { return loaded.scene(); }
    [[nodiscard]] const Json& root() const { return document->root; }
    [[nodiscard]] std::filesystem::path path() const { return folder / "scene.glb"; }
    [[nodiscard]] std::string element_count(const char* key) const { return std::to_string(array_size(root(), key)); }

private:
    void write(const ChartOptions& options, const Include& include) {
        geometry = flatten(scene(), loaded.context).value();
        charts = make_charts(scene(), geometry, options, loaded.context).value();
        atlas = make_atlas(scene(), geometry, charts, options, loaded.context).value();
        std::vector<LitTexture> textures;
        for (const AtlasPage& page : atlas.pages) textures.push_back(grey_page(page));
        const Status status = write_lit_gltf(
            path(), {*loaded.result->document, scene(), charts, atlas, textures, include, hash_geometry(geometry)});
        ASSERT_TRUE(status.ok()) << status.error().text();
        auto read = read_document(read_file(path(), 1u << 30).value(), path(), "written");
        ASSERT_TRUE(read.ok()) << read.error().text();
        document = std::move(read).value();
    }
};

// A cube of 8 shared vertices with smooth normals: every vertex lies on chart borders.
std::size_t add_cube(GltfBuilder& builder, Json rest = Json::object()) {
    std::vector<float> positions, normals;
    for (int i = 0; i < 8; ++i)
        for (int c = 0; c < 3; ++c) {
            positions.push_back(i >> c & 1 ? 1.0f : 0.0f);
            normals.push_back((i >> c & 1 ? 1.0f : -1.0f) / std::sqrt(3.0f));
        }
    const std::vector<std::uint16_t> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                             2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    rest["indices"] = builder.accessor(indices, "SCALAR");
    return builder.mesh(
        {{"POSITION", builder.accessor(positions, "VEC3")}, {"NORMAL", builder.accessor(normals, "VEC3")}},
        std::move(rest));
}

GltfBuilder two_cubes() {
    GltfBuilder builder;
    const std::size_t cube = add_cube(builder);
    builder.node({{"name", "left"}, {"mesh", cube}});
    builder.node({{"name", "right"}, {"mesh", cube}, {"translation", {3, 0, 0}}});
    return builder;
}

using Corners = std::array<int, 9>;

// World positions of a triangle in tenths of a millimetre.
Corners corners_of(const WorldGeometry& geometry, std::uint32_t triangle) {
    Corners out{};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 3; ++k)
            out[3 * c + k] = static_cast<int>(std::lround(1e4f * geometry.corners(triangle)[c][k]));
    return out;
}

// Every lightmapped triangle of the scene is in the written file at the same place, and its TEXCOORD_1 is what the
// atlas says; and read_baked_uvs says the same.
void expect_uvs_arrived(const Written& written) {
    Context context(1);
    const auto again = load_scene(written.path(), context);
    ASSERT_TRUE(again.ok()) << again.error().text();
    const WorldGeometry geometry = flatten(again->scene, context).value();
    std::map<Corners, std::array<Vec2, 3>> found;
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t)
        for (std::size_t c = 0; c < 3; ++c)
            found[corners_of(geometry, t)][c] = geometry.uv1[geometry.triangles[t].vertices[c]];
    EXPECT_EQ(geometry.triangle_count(), written.geometry.triangle_count());
    const auto baked = read_baked_uvs(written.path(), written.scene(), written.geometry);
    ASSERT_TRUE(baked.ok()) << baked.error().text();
    std::size_t compared = 0;
    for (std::uint32_t t = 0; t < written.geometry.triangle_count(); ++t) {
        const auto expected = written.atlas.triangle_uv(written.charts, written.geometry, written.scene(), t);
        EXPECT_EQ((*baked)[t].page, expected.page);
        const auto at = found.find(corners_of(written.geometry, t));
        ASSERT_NE(at, found.end()) << "triangle " << t;
        if (expected.page == kNone) continue;
        const AtlasPage& page = written.atlas.pages[expected.page];
        for (std::size_t c = 0; c < 3; ++c) {
            // One rounding of the division.
            EXPECT_NEAR((*baked)[t].uv[c].x, expected.texels[c].x / float(page.width), 1e-6);
            EXPECT_NEAR((*baked)[t].uv[c].y, expected.texels[c].y / float(page.height), 1e-6);
            EXPECT_EQ((*baked)[t].uv[c], at->second[c]);
        }
        ++compared;
    }
    EXPECT_GT(compared, 0u);
}

const Json& node_named(const Json& root, const char* name) {
    for (const Json& node : root["nodes"])
        if (node.value("name", "") == name) return node;
    ADD_FAILURE() << "no node " << name;
    return root;
}
const Json& primitive_of(const Json& root, const Json& node, std::size_t p = 0) {
    return root["meshes"][node["mesh"].get<std::size_t>()]["primitives"][p];
}
const Json& material_of(const Json& root, const Json& primitive) {
    return root["materials"][primitive["material"].get<std::size_t>()];
}

TEST(WriteGltf, UvsArriveWhereTheAtlasSays) { expect_uvs_arrived(Written(two_cubes())); }

TEST(WriteGltf, VerticesAreStoredOnceAndUvsPerInstance) {
    const Written written(two_cubes());
    const Json& left = primitive_of(written.root(), node_named(written.root(), "left"));
    const Json& right = primitive_of(written.root(), node_named(written.root(), "right"));
    EXPECT_NE(node_named(written.root(), "left")["mesh"], node_named(written.root(), "right")["mesh"]);
    EXPECT_EQ(left["attributes"]["POSITION"], right["attributes"]["POSITION"]);
    EXPECT_EQ(left["attributes"]["NORMAL"], right["attributes"]["NORMAL"]);
    EXPECT_EQ(left["indices"], right["indices"]);
    EXPECT_NE(left["attributes"]["TEXCOORD_1"], right["attributes"]["TEXCOORD_1"]);
    // 6 charts of 4 corners.
    EXPECT_EQ(open_accessor(*written.document, left["attributes"]["POSITION"])->count, 24u);
    EXPECT_EQ(written.element_count("meshes"), "2");
    // The 8 positions of the file are gone: 5 accessors of the shared part (2 attributes, indices, 2 of the compact
    // form, none of its own for triangles), UVs and transforms of 2 instances, and the transforms and pages of all.
    EXPECT_EQ(written.element_count("accessors"), "11");
}

TEST(WriteGltf, PositionBoundsAreThoseOfTheSplitVertices) {
    const Written written(two_cubes());
    const Json& primitive = primitive_of(written.root(), node_named(written.root(), "left"));
    const Json& accessor = written.root()["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(accessor["min"], Json({0.0, 0.0, 0.0}));
    EXPECT_EQ(accessor["max"], Json({1.0, 1.0, 1.0}));
}

TEST(WriteGltf, PrimitivesOnSeveralPagesAreCutByPage) {
    ChartOptions options = Written::default_options();
    options.texels_per_metre = 100;  // a side of the cube fills a page of 128
    options.max_page = 128;
    const Written written(two_cubes(), options);
    ASSERT_GT(written.atlas.pages.size(), 1u);
    expect_uvs_arrived(written);
    std::set<std::uint64_t> pages;
    const Json& node = node_named(written.root(), "left");
    for (const Json& primitive : written.root()["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
        const auto page = primitive["extensions"]["LUMEL_lightmap"]["page"].get<std::uint64_t>();
        EXPECT_EQ(material_of(written.root(), primitive)["extras"]["lumel"]["page"], page);
        EXPECT_TRUE(pages.insert(page).second) << "two primitives for one page";
    }
    EXPECT_GT(pages.size(), 1u);
}

TEST(WriteGltf, LitMaterialsShowTheTextureAndReflectNothing) {
    GltfBuilder builder;
    builder.add("materials", {{"name", "red"},
                              {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}},
                              {"doubleSided", true},
                              {"extras", {{"mine", 7}}}});
    builder.node({{"name", "cube"}, {"mesh", add_cube(builder, {{"material", 0}})}});
    const Written written(builder);
    const Json& root = written.root();
    const Json& lit = material_of(root, primitive_of(root, node_named(root, "cube")));
    EXPECT_EQ(lit["pbrMetallicRoughness"]["baseColorFactor"], Json({0, 0, 0, 1.0}));
    EXPECT_EQ(lit["pbrMetallicRoughness"]["metallicFactor"], 0);
    EXPECT_EQ(lit["emissiveFactor"], Json({1, 1, 1}));
    EXPECT_EQ(lit["emissiveTexture"]["texCoord"], 1);
    EXPECT_EQ(lit["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 2.5);
    EXPECT_EQ(lit["extensions"]["KHR_materials_specular"]["specularFactor"], 0);
    EXPECT_EQ(lit["doubleSided"], true);
    EXPECT_EQ(lit["extras"]["mine"], 7);
    EXPECT_EQ(lit["extras"]["lumel"]["original"], 0);
    EXPECT_EQ(root["materials"][0]["name"], "red");
    EXPECT_EQ(root["materials"][0].size(), 4u);  // untouched
    const Json& texture = root["textures"][lit["emissiveTexture"]["index"].get<std::size_t>()];
    const Json& sampler = root["samplers"][texture["sampler"].get<std::size_t>()];
    EXPECT_EQ(sampler["wrapS"], 33071);
    EXPECT_EQ(sampler["minFilter"], 9729);
    const auto png = written.document->image_bytes(texture["source"].get<std::uint64_t>());
    ASSERT_TRUE(png.ok());
    EXPECT_TRUE(decode_image(*png, "page").ok());
}

TEST(WriteGltf, CutOutMaterialsKeepTheirAlpha) {
    GltfBuilder builder;
    const std::vector<std::uint8_t> pixel{255, 255, 255, 255};
    const std::string uri = GltfBuilder::data_uri("image/png", encode_png(1, 1, 4, pixel));
    builder.add("images", {{"uri", uri}});
    builder.add("textures", {{"source", 0}});
    builder.add("materials", {{"alphaMode", "MASK"},
                              {"alphaCutoff", 0.25},
                              {"pbrMetallicRoughness",
                               {{"baseColorFactor", {1, 1, 1, 0.75}}, {"baseColorTexture", {{"index", 0}}}}}});
    builder.node({{"name", "cube"}, {"mesh", add_cube(builder, {{"material", 0}})}});
    const Written written(builder);
    const Json& lit = material_of(written.root(), primitive_of(written.root(), node_named(written.root(), "cube")));
    EXPECT_EQ(lit["alphaMode"], "MASK");
    EXPECT_EQ(lit["alphaCutoff"], 0.25);
    EXPECT_EQ(lit["pbrMetallicRoughness"]["baseColorFactor"], Json({0, 0, 0, 0.75}));
    EXPECT_EQ(lit["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
    // The image moved into the file.
    EXPECT_FALSE(written.root()["images"][0].contains("uri"));
    EXPECT_EQ(written.root()["images"][0]["mimeType"], "image/png");
    EXPECT_EQ(written.document->image_bytes(0).value(), encode_png(1, 1, 4, pixel));
}

TEST(WriteGltf, TheDefaultMaterialCanBePutBack) {
    const Written written(two_cubes());
    const Json& root = written.root();
    const Json& lit = material_of(root, primitive_of(root, node_named(root, "left")));
    EXPECT_EQ(root["materials"][lit["extras"]["lumel"]["original"].get<std::size_t>()]["name"], "default");
    // One clone for both instances.
    EXPECT_EQ(written.element_count("materials"), "2");
}

TEST(WriteGltf, BakedLightsMoveIntoExtras) {
    GltfBuilder builder = two_cubes();
    builder.root["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 5}}};
    builder.node({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Written written(builder);
    const Json& lamp = node_named(written.root(), "lamp");
    EXPECT_FALSE(lamp.contains("extensions"));
    EXPECT_EQ(lamp["extras"]["lumel"]["light"]["intensity"], 5);
    EXPECT_FALSE(written.root()["extensions"].contains("KHR_lights_punctual"));
    for (const Json& name : written.root()["extensionsUsed"]) EXPECT_NE(name, "KHR_lights_punctual");
}

// Light that is not in the bake has to come from somewhere.
TEST(WriteGltf, LightsStayWhereTheirDirectLightIsNotBaked) {
    GltfBuilder builder = two_cubes();
    builder.root["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    builder.node({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    Include include;
    include.direct = false;
    const Written written(builder, Written::default_options(), include);
    EXPECT_TRUE(node_named(written.root(), "lamp").contains("extensions"));
}

TEST(WriteGltf, InstancesBecomeChildNodes) {
    GltfBuilder builder;
    const std::size_t cube = add_cube(builder);
    const std::size_t translations = builder.accessor<float>({0, 0, 0, 3, 0, 0, 0, 3, 0.5f}, "VEC3");
    const std::size_t rotations =
        builder.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767}, "VEC4", true);
    builder.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    builder.node(
        {{"name", "many"},
         {"mesh", cube},
         {"translation", {1, 2, 3}},
         {"extensions",
          {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translations}, {"ROTATION", rotations}}}}}}}});
    const Written written(builder);
    expect_uvs_arrived(written);
    const Json& many = node_named(written.root(), "many");
    EXPECT_FALSE(many.contains("mesh"));
    EXPECT_FALSE(many.contains("extensions"));
    EXPECT_EQ(many["children"].size(), 3u);
    EXPECT_EQ(node_named(written.root(), "many#2")["translation"], Json({0.0, 3.0, 0.5}));
    for (const Json& name : written.root()["extensionsUsed"]) EXPECT_NE(name, "EXT_mesh_gpu_instancing");
}

TEST(WriteGltf, WhatTheBakeDoesNotTouchSurvives) {
    GltfBuilder builder = two_cubes();
    builder.root["extensionsUsed"] = {"VENDOR_thing"};
    builder.root["extensions"]["VENDOR_thing"] = {{"view", 0}, {"text", "kept"}};
    builder.root["extras"] = {{"author", "somebody"}};
    // A view that only the unknown extension knows.
    const std::vector<std::uint8_t> secret{1, 2, 3, 4, 5};
    const std::size_t view = builder.view(std::as_bytes(std::span(secret)));
    builder.root["extensions"]["VENDOR_thing"]["view"] = view;
    // A node that moves: it gets no lightmap, keeps its mesh, and the animation its data.
    const std::size_t mover = builder.node({{"name", "mover"}, {"mesh", builder.triangle()}});
    const std::size_t times = builder.accessor<float>({0, 1}, "SCALAR");
    const std::size_t places = builder.accessor<float>({0, 0, 0, 5, 6, 7}, "VEC3");
    builder.add(
        "animations",
        {{"samplers", Json::array({{{"input", times}, {"output", places}}})},
         {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", mover}, {"path", "translation"}}}}})}});
    builder.node({{"name", "left-over"}, {"extras", {{"note", 1}}}});
    const Written written(builder);
    const Json& root = written.root();
    EXPECT_EQ(root["extensions"]["VENDOR_thing"]["text"], "kept");
    EXPECT_EQ(root["extras"]["author"], "somebody");
    const auto kept = written.document->views[root["extensions"]["VENDOR_thing"]["view"].get<std::size_t>()];
    ASSERT_EQ(kept.size(), secret.size());
    EXPECT_EQ(std::memcmp(kept.data(), secret.data(), secret.size()), 0);
    const Json& sampler = root["animations"][0]["samplers"][0];
    EXPECT_EQ(open_accessor(*written.document, sampler["output"])->number(1, 2), 7.0f);
    EXPECT_EQ(open_accessor(*written.document, sampler["input"])->number(1, 0), 1.0f);
    const Json& primitive = primitive_of(root, node_named(root, "mover"));
    EXPECT_FALSE(primitive.contains("material"));
    EXPECT_FALSE(primitive["attributes"].contains("TEXCOORD_1"));
    EXPECT_EQ(open_accessor(*written.document, primitive["attributes"]["POSITION"])->number(1, 0), 1.0f);
    EXPECT_EQ(node_named(root, "left-over")["extras"]["note"], 1);
    expect_uvs_arrived(written);
}

TEST(WriteGltf, PointsAndLinesStay) {
    GltfBuilder builder;
    const std::size_t cube = add_cube(builder);
    const std::size_t line = builder.accessor<float>({9, 9, 9, 8, 8, 8}, "VEC3");
    builder.root["meshes"][cube]["primitives"].push_back({{"attributes", {{"POSITION", line}}}, {"mode", 1}});
    builder.node({{"name", "cube"}, {"mesh", cube}});
    const Written written(builder);
    const Json& kept = primitive_of(written.root(), node_named(written.root(), "cube"), 1);
    EXPECT_EQ(kept["mode"], 1);
    EXPECT_EQ(open_accessor(*written.document, kept["attributes"]["POSITION"])->number(0, 0), 9.0f);
}

TEST(WriteGltf, QuantisedNumbersStayAsTheyAre) {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    // Three bytes a normal, and a position of three shorts: both need padding.
    const std::vector<std::int16_t> corners{0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0};
    const std::vector<std::int8_t> ups{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
    const std::size_t positions = builder.accessor(builder.view(std::as_bytes(std::span(corners)), 8), 5122, "VEC3", 3);
    const std::size_t normals = builder.accessor(builder.view(std::as_bytes(std::span(ups)), 4), 5120, "VEC3", 3, true);
    builder.node({{"name", "t"}, {"mesh", builder.mesh({{"POSITION", positions}, {"NORMAL", normals}})}});
    const Written written(builder);
    expect_uvs_arrived(written);
    const Json& attributes = primitive_of(written.root(), node_named(written.root(), "t"))["attributes"];
    const Json& normal = written.root()["accessors"][attributes["NORMAL"].get<std::size_t>()];
    EXPECT_EQ(normal["componentType"], 5120);
    EXPECT_EQ(normal["normalized"], true);
    EXPECT_EQ(written.root()["bufferViews"][normal["bufferView"].get<std::size_t>()]["byteStride"], 4);
    EXPECT_EQ(open_accessor(*written.document, attributes["NORMAL"])->number(2, 2), 1.0f);
}

// A material that reads TEXCOORD_1 while the lightmap wants that set: the file's own moves on, for the original
// material alone where it is put back.
TEST(WriteGltf, TheFilesOwnSecondUvSetMakesRoom) {
    GltfBuilder builder;
    const std::vector<std::uint8_t> pixel{255, 255, 255, 255};
    builder.add("images", {{"uri", GltfBuilder::data_uri("image/png", encode_png(1, 1, 4, pixel))}});
    builder.add("textures", {{"source", 0}});
    builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}});
    // UVs that overlap and so cannot be the lightmap's: all corners in one place.
    const std::size_t positions = builder.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const std::size_t uv0 = builder.accessor<float>({0, 0, 0, 0, 0, 0}, "VEC2");
    const std::size_t uv1 = builder.accessor<float>({7, 7, 7, 7, 7, 7}, "VEC2");
    const Json attributes{{"POSITION", positions}, {"TEXCOORD_0", uv0}, {"TEXCOORD_1", uv1}};
    builder.node({{"name", "t"}, {"mesh", builder.mesh(attributes, {{"material", 0}})}});
    const Written written(builder);
    expect_uvs_arrived(written);
    const Json& root = written.root();
    const Json& primitive = primitive_of(root, node_named(root, "t"));
    ASSERT_TRUE(primitive["attributes"].contains("TEXCOORD_2"));
    EXPECT_EQ(open_accessor(*written.document, primitive["attributes"]["TEXCOORD_2"])->number(0, 0), 7.0f);
    const Json& lit = material_of(root, primitive);
    const Json& original = root["materials"][lit["extras"]["lumel"]["original"].get<std::size_t>()];
    EXPECT_EQ(original["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"], 2);
    EXPECT_EQ(root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"], 1);
}

TEST(WriteGltf, UnlitMaterialsStayUnlit) {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = {"KHR_materials_unlit"};
    builder.add("materials", {{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    builder.node({{"name", "cube"}, {"mesh", add_cube(builder, {{"material", 0}})}});
    const Written written(builder);
    EXPECT_EQ(primitive_of(written.root(), node_named(written.root(), "cube"))["material"], 0);
}

// The compact form: TEXCOORD_1 = chartUv * transform.xy + transform.zw.
TEST(WriteGltf, TheCompactFormGivesTheSameUvs) {
    const Written written(two_cubes());
    for (const char* name : {"left", "right"}) {
        const Json& node = node_named(written.root(), name);
        const Json& primitive = primitive_of(written.root(), node);
        const Json& compact = primitive["extensions"]["LUMEL_lightmap"];
        const auto charts = open_accessor(*written.document, compact["charts"]);
        const auto chart_uvs = open_accessor(*written.document, compact["chartUvs"]);
        const auto transforms = open_accessor(*written.document, node["extensions"]["LUMEL_lightmap"]["transforms"]);
        const auto uvs = open_accessor(*written.document, primitive["attributes"]["TEXCOORD_1"]);
        ASSERT_TRUE(charts.ok() && chart_uvs.ok() && transforms.ok() && uvs.ok());
        ASSERT_EQ(uvs->count, 24u);
        for (std::uint32_t v = 0; v < uvs->count; ++v)
            for (std::uint32_t c = 0; c < 2; ++c) {
                const std::uint32_t chart = charts->index(v);
                const float uv =
                    chart_uvs->number(v, c) * transforms->number(chart, c) + transforms->number(chart, c + 2);
                EXPECT_NEAR(uv, uvs->number(v, c), 1e-6);
            }
    }
}

TEST(WriteGltf, TheExtensionDescribesThePages) {
    const Written written(two_cubes());
    const Json& extension = written.root()["extensions"]["LUMEL_lightmap"];
    ASSERT_EQ(extension["pages"].size(), written.atlas.pages.size());
    EXPECT_EQ(extension["pages"][0]["lightmap"], "lightmap_0.exr");
    EXPECT_EQ(extension["pages"][0]["width"], written.atlas.pages[0].width);
    EXPECT_EQ(extension["units"]["lightmap"], "E/pi");
    EXPECT_EQ(extension["units"]["irradiance"], "E");
}

TEST(WriteGltf, TheSameInputGivesTheSameBytes) {
    const Written a(two_cubes()), b(two_cubes());
    EXPECT_EQ(read_file(a.path(), 1u << 30).value(), read_file(b.path(), 1u << 30).value());
}

}  // namespace
}  // namespace lumel
