// Whole files: every real scene loads, and no damage to one crashes or takes long.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "chart/charts_of_uv1.h"
#include "io/gltf_document_internal.h"
#include "io/image_io.h"
#include "io/info.h"
#include "scene/world_geometry.h"
#include "support/load_gltf.h"
#include "support/test_data.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;

// Triangles as the Khronos validator counts them, with the table's name of the scene.
struct RealScene {
    const char* name;
    std::size_t triangles, instances;
};

class RealScenes : public testing::TestWithParam<RealScene> {};

TEST_P(RealScenes, Loads) {
    const auto path = test::data_file(std::string("scenes/") + GetParam().name + ".glb");
    if (!path) GTEST_SKIP() << "no test data; set LUMEL_DATA";
    Context context(1);
    const auto loaded = load_scene(*path, context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    const Scene& scene = loaded->scene;
    EXPECT_EQ(scene.instances.size(), GetParam().instances);
    std::size_t triangles = 0;
    for (const Instance& instance : scene.instances) {
        triangles += scene.meshes[instance.mesh]->triangles.size();
        // Nothing of these scenes moves, and nothing visible may be taken for too small.
        EXPECT_TRUE(instance.node_class == NodeClass::lightmap || instance.node_class == NodeClass::volume)
            << instance.name;
    }
    EXPECT_EQ(triangles, GetParam().triangles);
    const auto geometry = flatten(scene, context);
    ASSERT_TRUE(geometry.ok()) << geometry.error().text();
    EXPECT_EQ(geometry->triangle_count(), triangles);
    EXPECT_EQ(loaded->document->meshes.size(), scene.meshes.size());
}

INSTANTIATE_TEST_SUITE_P(
    All, RealScenes,
    testing::Values(RealScene{"babylon_cornell_suzanne", 4006, 4}, RealScene{"bakinglab_box", 1808, 7},
                    RealScene{"bakinglab_white_room", 132, 1}, RealScene{"bench_cornell", 56, 5},
                    RealScene{"bench_corridor", 374, 3}, RealScene{"bench_courtyard", 298, 6},
                    RealScene{"bench_furnace", 50, 4}, RealScene{"bench_window_room", 148, 8},
                    RealScene{"bevy_cornell_box", 36, 4}, RealScene{"bevy_irradiance_volume", 32, 1},
                    RealScene{"bevy_mixed_lighting", 40898, 6}, RealScene{"cornell_box", 38, 8},
                    RealScene{"country_kitchen", 321063, 299}, RealScene{"crytek_sponza", 261839, 25},
                    RealScene{"cylinder_smooth", 28, 1}, RealScene{"dream_apartment", 177934, 1},
                    RealScene{"freedoom_e1m1", 3511, 111}, RealScene{"freedoom_e1m2", 7093, 294},
                    RealScene{"gazebo", 730, 1}, RealScene{"godot_living_room", 5088, 2},
                    RealScene{"godot_player", 1911, 1}, RealScene{"godot_room", 63720, 17},
                    RealScene{"godot_truck_town", 30461, 19}, RealScene{"godot_zdm2", 58772, 1},
                    RealScene{"hotel_room", 99029, 1}, RealScene{"japanese_bridge_garden", 21883, 1},
                    RealScene{"kenney_city", 21808, 122}, RealScene{"smooth_sphere_lowpoly", 840, 1},
                    RealScene{"tile_game_room", 88, 2}, RealScene{"van_gogh_room", 11272, 1},
                    RealScene{"webxr_camp", 6285, 1}, RealScene{"webxr_cave", 5894, 8},
                    RealScene{"webxr_garage", 11358, 1}, RealScene{"webxr_home_theater", 7915, 1}),
    [](const auto& info) { return info.param.name; });

// Counts how the loads of damaged copies ended, and holds each to ten seconds.
class Damage {
public:
    void load(std::span<const std::byte> bytes) {
        const auto start = std::chrono::steady_clock::now();
        Context context(1);
        const auto loaded = load_glb(bytes, "damaged.glb", context);
        if (loaded.ok()) {
            ++loaded_;
            EXPECT_TRUE(validate(loaded->scene).ok());
        } else {
            ++refused_;
            EXPECT_FALSE(loaded.error().message.empty());
            EXPECT_FALSE(loaded.error().where.empty());
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        slowest_ = std::max(slowest_, seconds);
    }
    ~Damage() {
        EXPECT_LT(slowest_, 10.0);
        EXPECT_GT(refused_, 0) << "no damage was noticed";
    }
    [[nodiscard]] int loaded() const { return loaded_; }

private:
    int loaded_ = 0, refused_ = 0;
    double slowest_ = 0.0;
};

std::vector<std::byte> cornell_box() {
    const auto path = test::data_file("scenes/cornell_box.glb");
    return path ? read_file(*path, 1 << 20).value() : std::vector<std::byte>{};
}

TEST(DamagedFiles, EveryBitOfEvery97thByteFlipped) {
    const std::vector<std::byte> whole = cornell_box();
    if (whole.empty()) GTEST_SKIP() << "no test data; set LUMEL_DATA";
    Damage damage;
    for (std::size_t at = 0; at < whole.size(); at += 97)
        for (unsigned bit = 0; bit < 9; ++bit) {
            std::vector<std::byte> bytes = whole;
            bytes[at] ^= bit == 8 ? std::byte{0xff} : static_cast<std::byte>(1u << bit);
            damage.load(bytes);
        }
    EXPECT_GT(damage.loaded(), 0) << "a flipped bit of a colour harms nobody";
}

TEST(DamagedFiles, EveryTruncationOfACornellBox) {
    const std::vector<std::byte> whole = cornell_box();
    if (whole.empty()) GTEST_SKIP() << "no test data; set LUMEL_DATA";
    Damage damage;
    for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 31)
        damage.load(std::span(whole).first(size));
    EXPECT_EQ(damage.loaded(), 0) << "no part is a whole file";
}

// The same for a document of our own that uses everything the reader knows, so that it runs without test data.
GltfBuilder everything() {
    GltfBuilder builder;
    builder.triangle_node();
    builder.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        builder.accessor<std::uint8_t>({9, 9, 9, 9, 8, 8, 8, 8, 7, 7, 7, 7}, "VEC4", true);
    builder.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        builder.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    builder.root["meshes"][0]["primitives"][0]["material"] = 0;
    const std::vector<std::uint8_t> pixels(16, 200);
    builder.add("images", {{"bufferView", builder.view(encode_png(2, 2, 4, pixels))}});
    builder.add("samplers", {{"wrapS", 33071}});
    builder.add("textures", {{"source", 0}, {"sampler", 0}});
    builder.add(
        "materials",
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"rotation", 1}}}}}}}}}});
    const std::size_t translations = builder.accessor<float>({0, 0, 0, 10, 0, 0}, "VEC3");
    builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = translations;
    builder.node({{"children", {0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
    builder.root["scenes"] = {{{"nodes", {1}}}};
    const std::vector<std::uint8_t> index{1};
    const std::vector<float> value{5, 5, 5};
    const std::size_t index_view = builder.view(std::as_bytes(std::span(index)));
    builder.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(std::as_bytes(std::span(value)))}}}};
    return builder;
}

TEST(DamagedFiles, EveryByteOfADocumentWithEverything) {
    const std::vector<std::byte> whole = everything().glb();
    {
        Context context(1);
        const auto loaded = load_glb(whole, "everything.glb", context);
        ASSERT_TRUE(loaded.ok()) << loaded.error().text();
        ASSERT_EQ(loaded->scene.instances.size(), 2u);
    }
    Damage damage;
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const unsigned mask : {1u, 0x80u, 0xffu}) {
            std::vector<std::byte> bytes = whole;
            bytes[at] ^= static_cast<std::byte>(mask);
            damage.load(bytes);
        }
    EXPECT_GT(damage.loaded(), 0);
}

TEST(LoadScene, SaysThatAFileIsNotThere) {
    Context context(1);
    const auto loaded = load_scene("/nowhere/room.glb", context);
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().code, ErrorCode::io);
    EXPECT_NE(loaded.error().text().find("/nowhere/room.glb"), std::string::npos);
}

TEST(LoadScene, AnEmptySceneHasNoTriangles) {
    EXPECT_TRUE(Loaded(GltfBuilder{}).error_says("has no triangles"));
    EXPECT_TRUE(Loaded(GltfBuilder{}).error_says("test.glb"));
}

TEST(LoadScene, NotesExtensionsItDoesNotKnow) {
    GltfBuilder builder;
    builder.triangle_node();
    builder.root["extensionsUsed"] = {"ACME_glow", "KHR_lights_punctual"};
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok());
    EXPECT_EQ(loaded.notes("ignored-extension"), 1u);
}

TEST(LoadScene, NotesThatAFileIsTheOutputOfABake) {
    GltfBuilder builder;
    builder.triangle_node();
    EXPECT_EQ(Loaded(builder).notes("already-baked"), 0u);
    builder.root["extensions"]["LUMEL_lightmap"] = {{"version", 1}};
    EXPECT_EQ(Loaded(builder).notes("already-baked"), 1u);
}

ChartSet kept_of(const Scene& scene, Context& context) {
    const WorldGeometry geometry = flatten(scene, context).value();
    return charts_of_uv1(scene, geometry, {}, context).value();
}

std::string described(Loaded& loaded) {
    const ChartSet uv1 = kept_of(loaded.scene(), loaded.context);
    return describe(loaded.scene(), uv1, loaded.context.diagnostics);
}

nlohmann::json json_of(Loaded& loaded) {
    const ChartSet uv1 = kept_of(loaded.scene(), loaded.context);
    return nlohmann::json::parse(describe_json(loaded.scene(), uv1, loaded.context.diagnostics));
}

// A triangle with these TEXCOORD_1 in one node, and in a second one where `twice`.
GltfBuilder triangle_with_uv1(const std::vector<float>& uv1, bool twice = false) {
    GltfBuilder builder;
    builder.triangle_node();
    builder.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = builder.accessor<float>(uv1, "VEC2");
    if (twice) builder.node({{"mesh", 0}, {"name", "second"}});
    return builder;
}

TEST(Info, SaysWhatABakeKeepsOfTheSecondUvs) {
    Loaded atlas(triangle_with_uv1({0, 0, 1, 0, 0, 1}));
    EXPECT_NE(described(atlas).find("UV 1       1 of 1 meshes: kept as one atlas of the scene\n"), std::string::npos);
    EXPECT_EQ(json_of(atlas)["uv1"]["one_atlas"], true);

    Loaded twice(triangle_with_uv1({0, 0, 1, 0, 0, 1}, true));
    const std::string repacked = described(twice);
    EXPECT_NE(repacked.find("1 of 1 meshes: 1 keep their charts, packed anew"), std::string::npos) << repacked;
    EXPECT_NE(repacked.find("'second'"), std::string::npos) << "why is said\n" << repacked;
    EXPECT_NE(repacked.find("shares its mesh with another node"), std::string::npos) << repacked;
    EXPECT_EQ(json_of(twice)["uv1"]["kept"], 1);

    Loaded outside(triangle_with_uv1({0, 0, 2, 0, 0, 1}));
    const std::string rejected = described(outside);
    EXPECT_NE(rejected.find("1 of 1 meshes: 1 rejected, charts will be made"), std::string::npos) << rejected;
    EXPECT_NE(rejected.find("it leaves [0, 1] at triangle 0"), std::string::npos) << rejected;
    EXPECT_EQ(json_of(outside)["uv1"]["rejected"], 1);
    EXPECT_EQ(json_of(outside)["uv1"]["one_atlas"], false);
}

TEST(Info, TellsWhatThereIs) {
    Loaded loaded(everything());
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const std::string text = described(loaded);
    for (const char* part : {"1 meshes, 2 instances, 2 triangles", "spot", "candela", "UV 0", "2 lightmap"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
    const auto json = json_of(loaded);
    EXPECT_EQ(json["triangles"], 2);
    EXPECT_EQ(json["lights"][0]["unit"], "candela");
    EXPECT_EQ(json["classes"]["lightmap"], 2);
    EXPECT_EQ(json["bounds"]["max"][0], 15.0) << "corner 1 was moved to (5,5,5), the second instance by 10";
}

TEST(Info, SaysThatThereIsNoLight) {
    GltfBuilder builder;
    builder.triangle_node();
    const auto told = [&] {
        Loaded loaded(builder);
        const std::string text = described(loaded);
        return std::pair(text.find("light      none") != std::string::npos, text.find("--sky") != std::string::npos);
    };
    EXPECT_EQ(told(), std::pair(true, true));
    builder.root["meshes"][0]["primitives"][0]["material"] = 0;
    builder.add("materials", {{"emissiveFactor", {1, 0.5, 0}}});
    EXPECT_EQ(told(), std::pair(true, false)) << "the triangle shines";
}

TEST(Info, MeasuresEmitters) {
    GltfBuilder builder;
    builder.triangle_node();
    builder.root["nodes"][0]["scale"] = {2, 2, 2};
    builder.root["meshes"][0]["primitives"][0]["material"] = 0;
    builder.add("materials", {{"name", "panel"}, {"emissiveFactor", {1, 0.5, 0}}});
    Loaded loaded(builder);
    const auto json = json_of(loaded);
    ASSERT_EQ(json["emitters"].size(), 1u);
    EXPECT_EQ(json["emitters"][0]["area"], 2.0) << "half a square metre, four times as large";
    EXPECT_EQ(json["emitters"][0]["radiance"][1], 0.5);
}

}  // namespace
}  // namespace lumel
