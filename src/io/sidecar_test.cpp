// The sidecar: what it sets, and that every fault names its key.
#include "io/sidecar.h"

#include <gtest/gtest.h>

#include "io/image_io.h"
#include "scene/world_geometry.h"
#include "support/load_gltf.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

// A room with a lamp (its light is called "bulb"), a sun and a group of two nodes.
GltfBuilder room() {
    GltfBuilder builder;
    const std::size_t mesh = builder.triangle();
    builder.node({{"name", "floor"}, {"mesh", mesh}});
    builder.node({{"name", "group"}, {"mesh", mesh}, {"children", {2}}});
    builder.node({{"name", "child"}, {"mesh", mesh}});
    builder.node(
        {{"name", "lamp"}, {"translation", {0, 2, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.node({{"name", "sun"},
                  {"rotation", {0.70710678118654752, 0, 0, -0.70710678118654752}},
                  {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "bulb"}},
                                                                   {{"type", "directional"}}};
    return builder;
}

// room.glb with `sidecar` beside it.
class Room {
public:
    explicit Room(const std::string& sidecar) {
        EXPECT_TRUE(write_file(folder_ / "room.glb", room().glb()).ok());
        EXPECT_TRUE(write_file(folder_ / "room.lumel.json", bytes_of(sidecar)).ok());
    }
    Result<LoadedScene> load() { return load_scene(folder_ / "room.glb", context_); }
    std::string error() {
        const auto loaded = load();
        return loaded.ok() ? "no error" : loaded.error().text();
    }
    test::TemporaryFolder& folder() { return folder_; }

private:
    test::TemporaryFolder folder_;
    Context context_{1};
};

TEST(Sidecar, StandsBesideTheScene) {
    EXPECT_EQ(sidecar_path("a/room.glb"), std::filesystem::path("a/room.lumel.json"));
    EXPECT_EQ(sidecar_path("a.b/room.v2.gltf"), std::filesystem::path("a.b/room.v2.lumel.json"));
}

TEST(Sidecar, AnEmptyOneChangesNothing) {
    Room plain("{}");
    auto loaded = plain.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    Context context(1);
    EXPECT_EQ(hash_scene(loaded->scene), hash_scene(load_glb(room().glb(), "room", context)->scene));
}

TEST(Sidecar, SetsLightsByNodeOrLightName) {
    Room with(R"({"version": 1, "lights": {
        "bulb": {"radius": 0.05, "bake": "indirect", "indirect_scale": 2, "indirect_colour": [1, 0.5, 0]},
        "sun": {"angle_degrees": 0.53}}})");
    const auto loaded = with.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    const Light& bulb = loaded->scene.lights[0];
    EXPECT_EQ(bulb.radius, 0.05f);
    EXPECT_EQ(bulb.bake, LightBake::indirect);
    EXPECT_EQ(bulb.indirect_scale, 2.0f);
    EXPECT_EQ(bulb.indirect_color, (Vec3{1, 0.5f, 0}));
    EXPECT_FLOAT_EQ(loaded->scene.lights[1].angular_diameter, 0.53f * 0.017453292f);
    EXPECT_EQ(loaded->scene.lights[1].bake, LightBake::all);
}

TEST(Sidecar, PlacesAreaLightsByCoordinates) {
    Room with(R"({"area_lights": [
        {"name": "panel", "shape": "rectangle", "width": 2, "height": 1, "position": [0, 3, 0], "direction": [0, -2, 0],
         "up": [0, 0, -1], "nits": 100, "color": [1, 0.5, 0.25]},
        {"shape": "disc", "radius": 0.5, "position": [1, 1, 1], "direction": [1, 0, 0], "nits": 10, "bake": "none"},
        {"shape": "sphere", "radius": 0.25, "position": [2, 2, 2], "nits": 5}]})");
    const auto loaded = with.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    ASSERT_EQ(loaded->scene.lights.size(), 5u);
    const Light& panel = loaded->scene.lights[2];
    EXPECT_EQ(panel.name, "panel");
    EXPECT_EQ(panel.shape, LightShape::rectangle);
    EXPECT_EQ(panel.intensity, (Vec3{100, 50, 25}));
    EXPECT_EQ(panel.direction, (Vec3{0, -1, 0}));
    EXPECT_EQ(panel.half_u, (Vec3{-1, 0, 0}));
    EXPECT_EQ(panel.half_v, (Vec3{0, 0, -0.5f}));
    EXPECT_EQ(cross(panel.half_u, panel.half_v), panel.direction * 0.5f)
        << "half_u x half_v points along the direction";
    const Light& disc = loaded->scene.lights[3];
    EXPECT_FLOAT_EQ(length(disc.half_u), 0.5f);
    EXPECT_NEAR(dot(disc.half_u, disc.half_v), 0.0f, 1e-6f);
    EXPECT_EQ(disc.bake, LightBake::none);
    EXPECT_EQ(disc.name, "area light 1");
    EXPECT_EQ(loaded->scene.lights[4].radius, 0.25f);
}

TEST(Sidecar, PlacesAreaLightsByNodes) {
    Room with(R"({"area_lights": [{"shape": "rectangle", "width": 1, "height": 1, "node": "lamp", "nits": 1}]})");
    const auto loaded = with.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    EXPECT_EQ(loaded->scene.lights[2].position, (Vec3{0, 2, 0}));
    EXPECT_EQ(loaded->scene.lights[2].direction, (Vec3{0, 0, -1})) << "along the node's -Z";
    Room without(R"({"area_lights": [{"shape": "sphere", "radius": 1, "node": "lump", "nits": 1}]})");
    EXPECT_NE(without.error().find("no node 'lump'"), std::string::npos);
    EXPECT_NE(without.error().find("'lamp'"), std::string::npos) << "the remedy lists the names";
}

TEST(Sidecar, SetsClassesAndDensitiesForNodesAndTheirChildren) {
    Room with(R"({"nodes": {"group": {"class": "occluder", "texel_density": 2}, "child": {"texel_density": 0.5},
                            "floor": {"class": "ignored"}}})");
    const auto loaded = with.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    const auto& instances = loaded->scene.instances;
    EXPECT_EQ(instances[0].node_class, NodeClass::ignored);
    EXPECT_EQ(instances[1].node_class, NodeClass::occluder);
    EXPECT_TRUE(instances[1].class_is_asked) << "bad charts do not change it";
    EXPECT_EQ(instances[1].density_scale, 2.0f);
    EXPECT_EQ(instances[2].node_class, NodeClass::occluder) << "from its parent";
    EXPECT_EQ(instances[2].density_scale, 0.5f) << "its own";
}

TEST(Sidecar, SetsASkyColour) {
    Room with(R"({"sky": {"color": [1, 2, 3], "intensity": 10, "rotation_degrees": 90}})");
    const auto loaded = with.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    EXPECT_EQ(loaded->scene.sky.color, (Vec3{10, 20, 30}));
    EXPECT_FLOAT_EQ(loaded->scene.sky.rotation, 1.5707963f);
    EXPECT_FALSE(loaded->scene.sky.map);
}

TEST(Sidecar, ReadsASkyMapBesideItself) {
    Room with(R"({"sky": {"map": "sky.hdr", "intensity": 4}})");
    Image image(4, 2, 3);
    for (float& value : image.data) value = 0.5f;
    ASSERT_TRUE(write_hdr(with.folder() / "sky.hdr", image).ok());
    const auto loaded = with.load();
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    ASSERT_TRUE(loaded->scene.sky.map);
    EXPECT_EQ(loaded->scene.sky.map->width, 4u);
    EXPECT_EQ(loaded->scene.sky.map->radiance[3], (Vec3{2, 2, 2}));
    Room without(R"({"sky": {"map": "gone.hdr"}})");
    EXPECT_NE(without.error().find("gone.hdr"), std::string::npos) << without.error();
}

std::string text_of(const char* file) {
    const auto bytes = read_file(std::filesystem::path(LUMEL_SOURCE_DIR) / file, 1 << 20);
    EXPECT_TRUE(bytes.ok()) << file;
    return bytes.ok() ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

TEST(Sidecar, TheExampleOfTheDocumentationIsRead) {
    const std::string page = text_of("docs/sidecar.md");
    const std::size_t begin = page.find("```json\n") + 8;
    const auto sidecar = parse_sidecar(page.substr(begin, page.find("```", begin) - begin), "docs/sidecar.md");
    ASSERT_TRUE(sidecar.ok()) << sidecar.error().text();
    EXPECT_EQ(sidecar->area_lights.size(), 3u);
    EXPECT_EQ(sidecar->nodes.size(), 3u);
}

// No key of the schema is unknown to the parser, and the schema lists every key that the parser lists.
TEST(Sidecar, SchemaAndParserKnowTheSameKeys) {
    const auto schema = nlohmann::json::parse(text_of("docs/schema/scene.lumel.schema.json"));
    const auto expect_known = [](const nlohmann::json& properties, const std::string& before,
                                 const std::string& after) {
        std::string known;
        for (const auto& property : properties.items()) {
            // null is no value of any key, so that every known key is refused for its value.
            const auto sidecar = parse_sidecar(before + "\"" + property.key() + "\": null" + after, "t");
            EXPECT_TRUE(sidecar.ok() || sidecar.error().message.find("unknown key") == std::string::npos)
                << property.key();
            known += " " + property.key();
        }
        const auto unknown = parse_sidecar(before + "\"no such key\": null" + after, "t");
        ASSERT_FALSE(unknown.ok());
        std::string listed = unknown.error().remedy.substr(std::string("known keys: ").size()) + ",";
        for (std::size_t comma = 0; (comma = listed.find(',')) != std::string::npos; listed.erase(0, comma + 2)) {
            const std::string key = listed.substr(0, comma);
            EXPECT_TRUE(properties.contains(key)) << key << " is not in the schema, which has" << known;
        }
    };
    expect_known(schema["properties"], "{", "}");
    expect_known(schema["$defs"]["light"]["properties"], "{\"lights\": {\"a\": {", "}}}");
    expect_known(schema["$defs"]["node"]["properties"], "{\"nodes\": {\"a\": {", "}}}");
    expect_known(schema["$defs"]["sky"]["properties"], "{\"sky\": {", "}}");
    auto area = schema["$defs"]["area_light"]["properties"];
    area.erase("radius");
    expect_known(area, "{\"area_lights\": [{\"shape\": \"rectangle\", ", "}]}");
    area = schema["$defs"]["area_light"]["properties"];
    area.erase("width");
    area.erase("height");
    expect_known(area, "{\"area_lights\": [{\"shape\": \"disc\", ", "}]}");
}

struct Fault {
    const char* expected;
    const char* sidecar;
};

class SidecarFault : public testing::TestWithParam<Fault> {};

TEST_P(SidecarFault, NamesTheKey) {
    Room with{std::string(GetParam().sidecar)};
    const std::string error = with.error();
    EXPECT_NE(error.find(GetParam().expected), std::string::npos) << error;
    EXPECT_NE(error.find("room.lumel.json"), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    All, SidecarFault,
    testing::Values(
        Fault{"no valid JSON", "{"}, Fault{"must be an object", "[]"}, Fault{"unknown key ''", R"({"": {}})"},
        Fault{"unknown key 'lihgts'", R"({"lihgts": {}})"}, Fault{"known keys: ", R"({"lihgts": {}})"},
        Fault{"version 2", R"({"version": 2})"},
        Fault{"lights 'bulb': unknown key 'raduis'", R"({"lights": {"bulb": {"raduis": 1}}})"},
        Fault{"no light 'blub'", R"({"lights": {"blub": {"radius": 1}}})"},
        Fault{"'radius' is -1", R"({"lights": {"bulb": {"radius": -1}}})"},
        Fault{"'radius' must be a number", R"({"lights": {"bulb": {"radius": "1"}}})"},
        Fault{"'radius' is for point and spot", R"({"lights": {"sun": {"radius": 1}}})"},
        Fault{"'angle_degrees' is for suns", R"({"lights": {"bulb": {"angle_degrees": 1}}})"},
        Fault{"one of: all, indirect, none", R"({"lights": {"bulb": {"bake": "some"}}})"},
        Fault{"has both 'indirect_color' and 'indirect_colour'",
              R"({"lights": {"bulb": {"indirect_color": [0, 1, 0], "indirect_colour": [0, 1, 0]}}})"},
        Fault{"'indirect_color' has a negative", R"({"lights": {"bulb": {"indirect_color": [0, -1, 0]}}})"},
        Fault{"no node 'wall'", R"({"nodes": {"wall": {"class": "probe"}}})"},
        Fault{"one of: lightmap", R"({"nodes": {"floor": {"class": "lit"}}})"},
        Fault{"'texel_density' is", R"({"nodes": {"floor": {"texel_density": 0}}})"},
        Fault{"unknown key 'tint'", R"({"sky": {"tint": [1, 1, 1]}})"},
        Fault{"either a 'color' or a 'map'", R"({"sky": {}})"},
        Fault{"either a 'color' or a 'map'", R"({"sky": {"color": [1, 1, 1], "map": "a.hdr"}})"},
        Fault{"array of 3 numbers", R"({"sky": {"color": [1, 1]}})"},
        Fault{"'shape' is missing", R"({"area_lights": [{}]})"},
        Fault{"area_lights[0]: 'width' is missing", R"({"area_lights": [{"shape": "rectangle", "height": 1}]})"},
        Fault{"unknown key 'width'", R"({"area_lights": [{"shape": "disc", "width": 1}]})"},
        Fault{"'nits' is missing", R"({"area_lights": [{"shape": "sphere", "radius": 1, "position": [0, 0, 0]}]})"},
        Fault{"needs a 'direction'",
              R"({"area_lights": [{"shape": "disc", "radius": 1, "position": [0, 0, 0], "nits": 1}]})"},
        Fault{
            "'direction' has no direction",
            R"({"area_lights": [{"shape": "disc", "radius": 1, "position": [0, 0, 0], "direction": [0, 0, 0], "nits": 1}]})"},
        Fault{
            "neither 'position'",
            R"({"area_lights": [{"shape": "disc", "radius": 1, "position": [0, 0, 0], "node": "lamp", "nits": 1}]})"}));

}  // namespace
}  // namespace lumel
