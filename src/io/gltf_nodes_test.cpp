// Node trees, instancing and classes from glTF made in code.
#include "io/gltf_nodes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/load_gltf.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;
using Json = GltfBuilder::Json;

constexpr double kHalf = 0.70710678118654752;  // sine and cosine of 45 degrees

void expect_near(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
    EXPECT_NEAR(a.z, b.z, 1e-5f);
}

TEST(GltfNodes, ComposesTranslationRotationAndScale) {
    GltfBuilder builder;
    builder.node({{"mesh", builder.triangle()},
                  {"translation", {1, 2, 3}},
                  {"rotation", {0, 0, kHalf, kHalf}},
                  {"scale", {2, 3, 4}}});
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    // Scale, then a quarter turn about z (x to y), then the translation.
    expect_near(transform_point(loaded.scene().instances[0].transform, {1, 0, 0}), {1, 4, 3});
    expect_near(transform_point(loaded.scene().instances[0].transform, {0, 1, 0}), {-2, 2, 3});
    expect_near(transform_point(loaded.scene().instances[0].transform, {0, 0, 1}), {1, 2, 7});
}

TEST(GltfNodes, ParentsMoveTheirChildren) {
    GltfBuilder builder;
    const std::size_t mesh = builder.triangle();
    // Children stand before and after their parent in the file.
    builder.node({{"mesh", mesh}, {"translation", {1, 0, 0}}});
    builder.node({{"children", {0, 2}}, {"rotation", {0, 0, kHalf, kHalf}}, {"translation", {0, 0, 5}}});
    builder.node({{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 1}}});
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    ASSERT_EQ(loaded.scene().instances.size(), 2u);
    expect_near(loaded.scene().instances[0].transform.translation, {0, 1, 5});
    expect_near(loaded.scene().instances[1].transform.translation, {-2, 0, 5});
    EXPECT_EQ(loaded.scene().instances[1].name, "node 2");
    EXPECT_EQ(loaded.scene().instances[0].mesh, loaded.scene().instances[1].mesh) << "one mesh, two instances";
    EXPECT_EQ(loaded.scene().display.instances[1].source.gltf_node, 2u);
    EXPECT_EQ(loaded.scene().display.instances[1].baked_instance, 1u);
}

// The path of names says which object it is, wherever it stands in the file; copies of one name share it.
TEST(GltfNodes, PathsAreOfNamesNotOfNumbers) {
    const auto paths = [](bool with_another) {
        GltfBuilder builder;
        const std::size_t mesh = builder.triangle();
        if (with_another) builder.node({{"name", "another"}, {"mesh", mesh}});
        const std::size_t chair = builder.node({{"name", "chair"}, {"mesh", mesh}});
        const std::size_t twin = builder.node({{"name", "chair"}, {"mesh", mesh}, {"translation", {1, 0, 0}}});
        builder.node({{"name", "room"}, {"children", {chair, twin}}});
        builder.node({{"name", "chair"}, {"mesh", mesh}});  // of no room
        builder.node({{"mesh", mesh}});
        const Loaded loaded(builder);
        EXPECT_TRUE(loaded.result.ok()) << loaded.error();
        std::vector<std::uint64_t> out;
        for (const Instance& instance : loaded.scene().instances) out.push_back(instance.path_hash);
        return out;
    };
    const auto before = paths(false);
    auto after = paths(true);
    ASSERT_EQ(before.size(), 4u);
    ASSERT_EQ(after.size(), 5u);
    after.erase(after.begin());
    EXPECT_EQ(before, after);
    EXPECT_EQ(before[0], before[1]);
    EXPECT_NE(before[0], before[2]) << "the same name elsewhere in the tree";
    EXPECT_NE(before[2], before[3]);
}

TEST(GltfNodes, NegativeScalesMirror) {
    GltfBuilder builder;
    builder.node({{"name", "left"}, {"mesh", builder.triangle()}, {"scale", {-1, 1, 1}}});
    const Loaded loaded(builder);
    EXPECT_EQ(loaded.scene().instances[0].name, "left");
    EXPECT_LT(determinant(loaded.scene().instances[0].transform), 0.0f);
}

TEST(GltfNodes, RefusesCyclesAndSharedChildren) {
    GltfBuilder cycle;
    cycle.triangle_node();
    cycle.node({{"children", {2}}});
    cycle.node({{"children", {1}}});
    EXPECT_TRUE(Loaded(cycle).error_says("cycle")) << Loaded(cycle).error();
    GltfBuilder self;
    self.triangle_node();
    self.root["nodes"][0]["children"] = {0};
    EXPECT_TRUE(Loaded(self).error_says("is its own")) << Loaded(self).error();
    GltfBuilder shared;
    shared.triangle_node();
    shared.node({{"children", {0}}});
    shared.node({{"children", {0}}});
    EXPECT_TRUE(Loaded(shared).error_says("more than one parent"));
    GltfBuilder beyond;
    beyond.triangle_node();
    beyond.root["nodes"][0]["children"] = {9};
    EXPECT_TRUE(Loaded(beyond).error_says("does not exist"));
}

// A chain of 100,000 nodes must neither overflow the stack nor take long.
TEST(GltfNodes, DeepChainsAreWalkedWithoutRecursion) {
    GltfBuilder builder;
    builder.triangle_node();
    for (int i = 1; i < 100000; ++i) builder.node({{"children", {i - 1}}, {"translation", {0.5, 0, 0}}});
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    EXPECT_EQ(loaded.scene().instances[0].transform.translation.x, 0.5f * 99999);
}

TEST(GltfNodes, ReadsTheDefaultSceneOnly) {
    GltfBuilder builder;
    const std::size_t mesh = builder.triangle();
    builder.node({{"name", "a"}, {"mesh", mesh}});
    builder.node({{"name", "b"}, {"children", {2}}});
    builder.node({{"name", "c"}, {"mesh", mesh}});
    const auto names = [](const GltfBuilder& b) {
        const Loaded loaded(b);
        std::string out;
        for (const Instance& instance : loaded.scene().instances) out += instance.name;
        return out;
    };
    EXPECT_EQ(names(builder), "ac") << "without scenes: all";
    builder.root["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
    EXPECT_EQ(names(builder), "c") << "the first where none is the default";
    builder.root["scene"] = 1;
    EXPECT_EQ(names(builder), "a");
    builder.root["scene"] = 2;
    EXPECT_TRUE(Loaded(builder).error_says("scenes[2]"));
    builder.root["scene"] = 0;
    builder.root["scenes"][0]["nodes"] = Json::array();
    EXPECT_TRUE(Loaded(builder).error_says("no triangles"));
}

TEST(GltfNodes, RefusesTransformsThatAreNone) {
    const auto with = [](const char* key, Json value) {
        GltfBuilder builder;
        builder.triangle_node();
        builder.root["nodes"][0][key] = std::move(value);
        return Loaded(builder).error();
    };
    EXPECT_NE(with("rotation", {0, 0, 0, 0}).find("length zero"), std::string::npos);
    EXPECT_NE(with("translation", {1, 2}).find("'translation' must be an array of 3 numbers"), std::string::npos);
    EXPECT_NE(with("matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).find("not affine"), std::string::npos);
    EXPECT_NE(with("scale", {1, 1, "1"}).find("'scale'"), std::string::npos);
}

TEST(GltfNodes, UnnormalisedQuaternionsTurnWithoutScaling) {
    const AffineD m = compose({0, 0, 0}, {0, 0, 3, 3}, {1, 1, 1});
    expect_near(m.rounded().columns[0], {0, 1, 0});
}

GltfBuilder instanced() {
    GltfBuilder builder;
    const std::size_t translations = builder.accessor<float>({0, 0, 0, 10, 0, 0}, "VEC3");
    const std::size_t rotations = builder.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, "VEC4", true);
    const std::size_t scales = builder.accessor<float>({1, 1, 1, 2, 2, 2}, "VEC3");
    builder.node({{"name", "tree"},
                  {"mesh", builder.triangle()},
                  {"translation", {0, 0, 1}},
                  {"extensions",
                   {{"EXT_mesh_gpu_instancing",
                     {{"attributes", {{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}}}}}}}});
    builder.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return builder;
}

TEST(GltfNodes, ExpandsGpuInstancing) {
    const Loaded loaded(instanced());
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const Scene& scene = loaded.scene();
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[1].name, "tree#1");
    EXPECT_EQ(scene.display.instances[1].source.instancing_index, 1u);
    EXPECT_EQ(scene.display.instances[1].source.gltf_node, 0u);
    expect_near(transform_point(scene.instances[0].transform, {1, 0, 0}), {1, 0, 1});
    // Scale 2, a quarter turn about z, (10, 0, 0), and the node's own (0, 0, 1). 16-bit quaternions err by 2e-5.
    const Vec3 p = transform_point(scene.instances[1].transform, {1, 0, 0});
    EXPECT_NEAR(p.x, 10, 1e-4f);
    EXPECT_NEAR(p.y, 2, 1e-4f);
    EXPECT_NEAR(p.z, 1, 1e-4f);
}

TEST(GltfNodes, RefusesUnequalInstancingCounts) {
    GltfBuilder builder = instanced();
    builder.root["accessors"][2]["count"] = 1;
    EXPECT_TRUE(Loaded(builder).error_says("different numbers of instances"));
}

// Nodes that share one accessor of instances, each with a mesh of many triangles.
TEST(GltfNodes, InstancesCannotExpandWithoutBound) {
    GltfBuilder builder = instanced();
    for (const char* key : {"ROTATION", "SCALE"})
        builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"].erase(key);
    builder.root["accessors"][0] = {{"componentType", 5126}, {"count", 60000}, {"type", "VEC3"}};
    const Json node = builder.root["nodes"][0];
    EXPECT_TRUE(Loaded(builder).result.ok()) << Loaded(builder).error();
    for (int i = 0; i < 5; ++i) builder.root["nodes"].push_back(node);
    EXPECT_TRUE(Loaded(builder).error_says("instances, more than such a file can hold")) << Loaded(builder).error();
}

TEST(GltfNodes, ClassesFollowTheRule) {
    GltfBuilder builder;
    const std::size_t mesh = builder.triangle();
    builder.node({{"name", "plain"}, {"mesh", mesh}});
    builder.node({{"name", "skinned"}, {"mesh", mesh}, {"skin", 0}});
    builder.node({{"name", "moving"}, {"children", {3}}});
    builder.node({{"name", "rider"}, {"mesh", mesh}});
    builder.node({{"name", "unlit"}, {"mesh", mesh}, {"extras", {{"lightmap", false}}}, {"children", {5}}});
    builder.node({{"name", "below"}, {"mesh", mesh}});
    builder.node({{"name", "kept"}, {"mesh", mesh}, {"skin", 0}, {"extras", {{"lightmap", true}}}});
    // 1.4 cm in a scene of 20 m, and 1.4 mm.
    builder.node({{"name", "cup"}, {"mesh", mesh}, {"scale", {0.02, 0.02, 0.02}}});
    builder.node({{"name", "screw"}, {"mesh", mesh}, {"scale", {0.001, 0.001, 0.001}}, {"translation", {20, 0, 0}}});
    builder.root["skins"] = {{{"joints", {0}}}};
    builder.root["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    const std::vector<NodeClass> expected{NodeClass::lightmap, NodeClass::probe,  NodeClass::probe,
                                          NodeClass::volume,   NodeClass::volume, NodeClass::lightmap,
                                          NodeClass::lightmap, NodeClass::probe};
    ASSERT_EQ(loaded.scene().instances.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(loaded.scene().instances[i].node_class, expected[i]) << loaded.scene().instances[i].name;
        EXPECT_EQ(loaded.scene().display.instances[i].baked_instance == kNone, expected[i] != NodeClass::lightmap);
        // What the file says of a node, its charts do not change.
        const std::string& name = loaded.scene().instances[i].name;
        EXPECT_EQ(loaded.scene().instances[i].class_is_asked, name == "unlit" || name == "below" || name == "kept");
    }
    EXPECT_EQ(loaded.notes("node-class"), 5u);
}

}  // namespace
}  // namespace lumel
