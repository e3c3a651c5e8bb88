// Meshes from glTF made in code.
#include "io/gltf_meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/load_gltf.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;
using Json = GltfBuilder::Json;

// Corners of the unit square in the plane z = 0, counter-clockwise.
const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> kUp{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};

// A node with a mesh of one primitive over the square; `edit` may change attributes and primitive.
template <class Edit>
GltfBuilder square(Edit&& edit) {
    GltfBuilder builder;
    Json attributes{{"POSITION", builder.accessor(kSquare, "VEC3")}, {"NORMAL", builder.accessor(kUp, "VEC3")}};
    Json primitive = Json::object();
    primitive["indices"] = builder.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    edit(builder, attributes, primitive);
    builder.node({{"mesh", builder.mesh(attributes, primitive)}});
    return builder;
}

const Mesh& mesh_of(const Loaded& loaded) { return *loaded.scene().meshes.at(0); }

float total_area_z(const Mesh& mesh) {
    float area = 0.0f;
    for (const Triangle& t : mesh.triangles)
        area +=
            0.5f * cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]).z;
    return area;
}

TEST(GltfMeshes, ReadsAPlainMesh) {
    const Loaded loaded(square([](auto&, auto&, auto&) {}));
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const Mesh& mesh = mesh_of(loaded);
    EXPECT_EQ(mesh.name, "mesh 0");
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[2], (Vec3{1, 1, 0}));
    EXPECT_EQ(mesh.normals[1], (Vec3{0, 0, 1}));
    EXPECT_TRUE(mesh.uv0.empty() && mesh.uv1.empty() && mesh.colors.empty());
    EXPECT_EQ(total_area_z(mesh), 1.0f);
    EXPECT_EQ(loaded.scene().display.meshes[0], loaded.scene().meshes[0]) << "shown and baked share the Mesh";
}

TEST(GltfMeshes, ReadsIndicesOfEveryWidthAndNone) {
    for (int width = 0; width < 3; ++width) {
        const Loaded loaded(square([&](GltfBuilder& b, Json&, Json& primitive) {
            if (width == 0) primitive["indices"] = b.accessor<std::uint8_t>({0, 1, 2}, "SCALAR");
            if (width == 1) primitive["indices"] = b.accessor<std::uint32_t>({0, 1, 2}, "SCALAR");
            if (width == 2) {
                primitive.erase("indices");
                primitive["mode"] = 6;  // a fan of the four corners
            }
        }));
        ASSERT_TRUE(loaded.result.ok()) << loaded.error();
        EXPECT_EQ(total_area_z(mesh_of(loaded)), width == 2 ? 1.0f : 0.5f);
    }
}

// Vertices 0 1 3 2 make a strip whose both triangles turn counter-clockwise; 0 1 2 3 a fan.
TEST(GltfMeshes, UnrollsStripsAndFans) {
    const auto with = [](int mode, std::vector<std::uint16_t> indices) {
        return Loaded(square([&](GltfBuilder& b, Json&, Json& primitive) {
            primitive["mode"] = mode;
            primitive["indices"] = b.accessor(indices, "SCALAR");
        }));
    };
    const Loaded strip = with(5, {0, 1, 3, 2});
    ASSERT_TRUE(strip.result.ok()) << strip.error();
    EXPECT_EQ(mesh_of(strip).triangles.size(), 2u);
    EXPECT_EQ(total_area_z(mesh_of(strip)), 1.0f) << "a wrongly wound triangle would count negative";
    const Loaded stitched = with(5, {0, 1, 3, 1, 1, 2, 3});
    EXPECT_EQ(mesh_of(stitched).triangles.size(), 2u) << "what names a vertex twice is dropped";
    EXPECT_EQ(total_area_z(mesh_of(stitched)), 1.0f);
    const Loaded fan = with(6, {0, 1, 2, 3});
    EXPECT_EQ(mesh_of(fan).triangles.size(), 2u);
    EXPECT_EQ(total_area_z(mesh_of(fan)), 1.0f);
}

TEST(GltfMeshes, SkipsPointsAndLinesWithANote) {
    for (const int mode : {0, 1, 2, 3}) {
        GltfBuilder builder = square([](auto&, auto&, auto&) {});
        Json lines = builder.root["meshes"][0]["primitives"][0];
        lines["mode"] = mode;
        builder.root["meshes"][0]["primitives"].insert(builder.root["meshes"][0]["primitives"].begin(), lines);
        const Loaded loaded(builder);
        ASSERT_TRUE(loaded.result.ok()) << loaded.error();
        EXPECT_EQ(mesh_of(loaded).primitives.size(), 1u);
        EXPECT_EQ(loaded.notes("skipped-primitive"), 1u);
    }
    EXPECT_TRUE(Loaded(square([](auto&, auto&, Json& p) { p["mode"] = 7; })).error_says("'mode' is 7"));
    EXPECT_TRUE(Loaded(square([](auto&, auto&, Json& p) { p["mode"] = 1; })).error_says("no triangles"));
}

TEST(GltfMeshes, FlatShadesWhereNormalsAreAbsent) {
    GltfBuilder builder = square([](GltfBuilder& b, Json& attributes, Json&) {
        attributes.erase("NORMAL");
        // Fold the square: corner 3 rises, so that the two triangles face different ways.
        attributes["POSITION"] = b.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1}, "VEC3");
        attributes["TEXCOORD_0"] = b.accessor<float>({0, 0, 0.25f, 0, 0.5f, 0, 0.75f, 0}, "VEC2");
    });
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const Mesh& mesh = mesh_of(loaded);
    ASSERT_EQ(mesh.positions.size(), 6u) << "one vertex per corner";
    EXPECT_EQ(mesh.triangles[1], (Triangle{3, 4, 5}));
    EXPECT_EQ(mesh.normals[0], (Vec3{0, 0, 1}));
    // (1,1,0) x (0,1,1) = (1,-1,1): the face of corners 0, 2, 3.
    EXPECT_NEAR(mesh.normals[3].x, 1 / std::sqrt(3.0f), 1e-6f);
    EXPECT_NEAR(mesh.normals[3].y, -1 / std::sqrt(3.0f), 1e-6f);
    EXPECT_EQ(mesh.uv0[4].x, 0.5f) << "attributes follow their corner";
    EXPECT_EQ(loaded.notes("missing-normals"), 1u);
}

TEST(GltfMeshes, ReplacesNormalsOfLengthZero) {
    const Loaded loaded(square([](GltfBuilder& b, Json& attributes, Json&) {
        attributes["NORMAL"] = b.accessor<float>({0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 2}, "VEC3");
    }));
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    EXPECT_EQ(mesh_of(loaded).normals[1], (Vec3{0, 0, 1}));
    EXPECT_EQ(mesh_of(loaded).normals[3], (Vec3{0, 0, 1})) << "others are brought to unit length";
    EXPECT_EQ(mesh_of(loaded).positions.size(), 4u) << "the vertices stay as they are";
    EXPECT_EQ(loaded.notes("zero-length-normal"), 1u);
}

TEST(GltfMeshes, LeavesOutVerticesThatNoTriangleUses) {
    // Two primitives share one buffer of four vertices.
    GltfBuilder builder = square([](GltfBuilder& b, Json&, Json& p) {
        p["indices"] = b.accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
    });
    Json other = builder.root["meshes"][0]["primitives"][0];
    other["indices"] = builder.accessor<std::uint16_t>({3, 0, 2}, "SCALAR");
    builder.root["meshes"][0]["primitives"].push_back(other);
    Context context(1);
    auto loaded = load_glb(builder.glb(), "test.glb", context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    const Mesh& mesh = *loaded->scene.meshes[0];
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.primitives[1].first_vertex, 3u);
    EXPECT_EQ(mesh.triangles[1], (Triangle{5, 3, 4})) << "order of the file: elements 0, 2, 3";
    EXPECT_EQ(mesh.positions[5], (Vec3{0, 1, 0}));
    const GltfDocument& document = *loaded->document;
    ASSERT_EQ(document.meshes.size(), 1u);
    EXPECT_EQ(document.meshes[0].primitives[1].vertex, (std::vector<std::uint32_t>{0, 2, 3}));
    EXPECT_EQ(document.meshes[0].primitives[1].gltf_primitive, 1u);
}

TEST(GltfMeshes, VertexSourcesPointBackIntoTheAccessors) {
    GltfBuilder builder = square([](GltfBuilder&, Json& attributes, Json&) { attributes.erase("NORMAL"); });
    Context context(1);
    auto loaded = load_glb(builder.glb(), "test.glb", context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    const Mesh& mesh = *loaded->scene.meshes[0];
    const PrimitiveSource& source = loaded->document->meshes[0].primitives[0];
    EXPECT_TRUE(source.made_normals);
    const auto accessor = loaded->document->accessor_bytes(0);
    ASSERT_TRUE(accessor.ok());
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        EXPECT_EQ(mesh.positions[v].y, accessor->number(source.element(v), 1)) << v;
}

TEST(GltfMeshes, ReadsColoursOfEveryKind) {
    const auto color = [](auto&& make) {
        const Loaded loaded(square([&](GltfBuilder& b, Json& attributes, Json&) { attributes["COLOR_0"] = make(b); }));
        EXPECT_TRUE(loaded.result.ok()) << loaded.error();
        return mesh_of(loaded).colors.at(1);
    };
    const std::vector<float> floats{0, 0, 0, 0.25f, 0.5f, 2, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(color([&](GltfBuilder& b) { return b.accessor(floats, "VEC3"); }), (Vec4{0.25f, 0.5f, 2, 1}));
    const std::vector<std::uint8_t> bytes{0, 0, 0, 0, 255, 51, 0, 102, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(color([&](GltfBuilder& b) { return b.accessor(bytes, "VEC4", true); }), (Vec4{1, 0.2f, 0, 0.4f}));
    EXPECT_EQ(color([&](GltfBuilder& b) { return b.accessor(bytes, "VEC4", false); }), (Vec4{1, 0.2f, 0, 0.4f}));
    const std::vector<std::uint16_t> shorts{0, 0, 0, 0, 65535, 13107, 0, 65535, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(color([&](GltfBuilder& b) { return b.accessor(shorts, "VEC4", true); }), (Vec4{1, 0.2f, 0, 1}));
}

TEST(GltfMeshes, ReadsQuantisedAttributes) {
    const Loaded loaded(square([](GltfBuilder& b, Json& attributes, Json&) {
        // Views of 8 bytes per vertex, as quantised files have them.
        const std::vector<std::uint16_t> positions{0, 0, 0, 0, 65535, 0, 0, 0, 65535, 65535, 0, 0, 0, 65535, 0, 0};
        attributes["POSITION"] = b.accessor(b.view(std::as_bytes(std::span(positions)), 8), 5123, "VEC3", 4, true);
        const std::vector<std::int8_t> normals{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
        attributes["NORMAL"] = b.accessor(b.view(std::as_bytes(std::span(normals)), 4), 5120, "VEC3", 4, true);
        const std::vector<std::int16_t> uvs{0, 0, 100, -100,
                                            0, 0, 0,   0};  // not normalised: KHR_texture_transform scales them
        attributes["TEXCOORD_0"] = b.accessor(uvs, "VEC2", false);
        attributes["TEXCOORD_1"] = b.accessor<std::uint8_t>({0, 0, 255, 51, 0, 0, 0, 0}, "VEC2", true);
        b.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    }));
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const Mesh& mesh = mesh_of(loaded);
    EXPECT_EQ(mesh.positions[2], (Vec3{1, 1, 0}));
    EXPECT_EQ(mesh.normals[0], (Vec3{0, 0, 1}));
    EXPECT_EQ(mesh.uv0[1], (Vec2{100, -100}));
    EXPECT_EQ(mesh.uv1[1], (Vec2{1, 0.2f}));
}

TEST(GltfMeshes, FillsAttributesThatOnlySomePrimitivesHave) {
    GltfBuilder builder = square([](auto&, auto&, auto&) {});
    Json second = builder.root["meshes"][0]["primitives"][0];
    second["attributes"]["TEXCOORD_1"] = builder.accessor<float>({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");
    Json third = builder.root["meshes"][0]["primitives"][0];
    third["attributes"]["COLOR_0"] = builder.accessor<float>(std::vector<float>(12, 0.5f), "VEC3");
    builder.root["meshes"][0]["primitives"].push_back(second);
    builder.root["meshes"][0]["primitives"].push_back(third);
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const Mesh& mesh = mesh_of(loaded);
    ASSERT_EQ(mesh.uv1.size(), 12u);
    EXPECT_EQ(mesh.uv1[2], Vec2{});
    EXPECT_EQ(mesh.uv1[6], (Vec2{1, 1}));
    EXPECT_EQ(mesh.uv1[11], Vec2{});
    ASSERT_EQ(mesh.colors.size(), 12u);
    EXPECT_EQ(mesh.colors[0], (Vec4{1, 1, 1, 1}));
    EXPECT_EQ(mesh.colors[8].x, 0.5f);
}

TEST(GltfMeshes, NamesTheVertexThatIsNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const Loaded loaded(square([&](GltfBuilder& b, Json& attributes, Json&) {
            std::vector<float> positions = kSquare;
            positions[7] = bad;
            attributes["POSITION"] = b.accessor(positions, "VEC3");
        }));
        EXPECT_TRUE(loaded.error_says("mesh 0, primitive 0, vertex 2")) << loaded.error();
        EXPECT_TRUE(loaded.error_says("POSITION is not finite")) << loaded.error();
    }
    const Loaded uv(square([](GltfBuilder& b, Json& attributes, Json&) {
        attributes["TEXCOORD_1"] = b.accessor<float>({0, 0, 0, 0, 0, std::nanf(""), 0, 0}, "VEC2");
    }));
    EXPECT_TRUE(uv.error_says("vertex 2: TEXCOORD_1")) << uv.error();
}

TEST(GltfMeshes, RefusesBrokenTopology) {
    const auto indices = [](std::vector<std::uint16_t> values) {
        return Loaded(square([&](GltfBuilder& b, Json&, Json& p) { p["indices"] = b.accessor(values, "SCALAR"); }))
            .error();
    };
    EXPECT_NE(indices({0, 1, 4}).find("index 2 is 4, out of range"), std::string::npos) << indices({0, 1, 4});
    EXPECT_NE(indices({0, 1, 2, 3}).find("not a multiple of three"), std::string::npos);
    EXPECT_TRUE(Loaded(square([](auto&, Json& a, auto&) { a["NORMAL"] = 2; })).error_says("NORMAL"));
    EXPECT_TRUE(Loaded(square([](GltfBuilder& b, Json& a, auto&) {
                    a["TEXCOORD_0"] = b.accessor<float>({0, 0}, "VEC2");
                })).error_says("different numbers of elements"));
    EXPECT_TRUE(Loaded(square([](auto&, auto&, Json& p) { p["material"] = 3; })).error_says("materials[3]"));
    EXPECT_TRUE(Loaded(square([](GltfBuilder& b, auto&, Json& p) {
                    p["indices"] = b.accessor<float>({0, 1, 2}, "SCALAR");
                })).error_says("unsigned integers"));
}

TEST(GltfMeshes, DracoWithoutFallbackIsAClearError) {
    const Loaded loaded(square([](GltfBuilder& b, Json& attributes, Json& primitive) {
        attributes["POSITION"] = b.add("accessors", {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
        primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
    }));
    EXPECT_TRUE(loaded.error_says("KHR_draco_mesh_compression")) << loaded.error();
    EXPECT_TRUE(loaded.error_says("gltf-transform")) << loaded.error();
}

// A thousand primitives that share one index buffer of 30,000 triangles: a file of 400 kB that would make 90 million
// vertices.
TEST(GltfMeshes, SharedAccessorsCannotExpandWithoutBound) {
    GltfBuilder builder = square([](GltfBuilder& b, Json& attributes, Json& primitive) {
        std::vector<std::uint16_t> indices;
        for (std::size_t i = 0; i < 30000; ++i) indices.insert(indices.end(), {0, 1, 2});
        attributes.erase("NORMAL");
        primitive["indices"] = b.accessor(indices, "SCALAR");
    });
    Json& primitives = builder.root["meshes"][0]["primitives"];
    const Json one = primitives[0];
    for (int i = 0; i < 1000; ++i) primitives.push_back(one);
    EXPECT_TRUE(Loaded(builder).error_says("grows to far more vertices")) << Loaded(builder).error();
}

}  // namespace
}  // namespace lumel
