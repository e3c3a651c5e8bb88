// Lights and cameras from glTF made in code.
#include "io/gltf_lights.h"

#include <gtest/gtest.h>

#include "support/load_gltf.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;
using Json = GltfBuilder::Json;

// A scene with one light on a node that stands at (1, 2, 3), turned a quarter about y (so that -z points to -x) and
// scaled, which a light must not feel.
GltfBuilder with_light(Json light) {
    GltfBuilder builder;
    builder.triangle_node();
    builder.node({{"name", "lamp"},
                  {"translation", {1, 2, 3}},
                  {"rotation", {0, 0.70710678118654752, 0, 0.70710678118654752}},
                  {"scale", {3, 3, 3}},
                  {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({std::move(light)});
    return builder;
}

TEST(GltfLights, ReadsASpot) {
    const Loaded loaded(with_light({{"name", "bulb"},
                                    {"type", "spot"},
                                    {"color", {1, 0.5, 0}},
                                    {"intensity", 40},
                                    {"range", 12},
                                    {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}));
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    ASSERT_EQ(loaded.scene().lights.size(), 1u);
    const Light& light = loaded.scene().lights[0];
    EXPECT_EQ(light.name, "lamp") << "named after its node";
    EXPECT_EQ(light.shape, LightShape::spot);
    EXPECT_EQ(light.intensity, (Vec3{40, 20, 0}));
    EXPECT_EQ(light.position, (Vec3{1, 2, 3}));
    EXPECT_NEAR(light.direction.x, -1.0f, 1e-6f);
    EXPECT_EQ(light.range, 12.0f);
    EXPECT_EQ(light.inner_cone, 0.1f);
    EXPECT_EQ(light.outer_cone, 0.5f);
    EXPECT_EQ(light.radius, 0.0f);
}

TEST(GltfLights, FillsDefaults) {
    const Loaded point(with_light({{"type", "point"}}));
    ASSERT_TRUE(point.result.ok()) << point.error();
    EXPECT_EQ(point.scene().lights[0].intensity, (Vec3{1, 1, 1}));
    EXPECT_EQ(point.scene().lights[0].range, 0.0f) << "infinite";
    const Loaded sun(with_light({{"type", "directional"}, {"intensity", 100000}}));
    EXPECT_EQ(sun.scene().lights[0].shape, LightShape::sun);
    EXPECT_EQ(sun.scene().lights[0].angular_diameter, 0.0f);
    const Loaded spot(with_light({{"type", "spot"}}));
    EXPECT_FLOAT_EQ(spot.scene().lights[0].outer_cone, 0.785398163f);
}

TEST(GltfLights, RefusesNonsense) {
    EXPECT_TRUE(Loaded(with_light({{"type", "laser"}})).error_says("laser"));
    EXPECT_TRUE(Loaded(with_light(Json::object())).error_says("'type' is missing"));
    EXPECT_TRUE(Loaded(with_light({{"type", "point"}, {"intensity", -1}})).error_says("intensity"));
    EXPECT_TRUE(
        Loaded(with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.9}}}})).error_says("inner <= outer"));
    GltfBuilder builder = with_light({{"type", "point"}});
    builder.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 1;
    EXPECT_TRUE(Loaded(builder).error_says("lights[1]"));
    builder.root.erase("extensions");
    EXPECT_TRUE(Loaded(builder).error_says("the document has no lights"));
}

TEST(GltfCameras, ReadsPerspectiveOnly) {
    GltfBuilder builder;
    builder.triangle_node();
    builder.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"aspectRatio", 1.5}, {"znear", 0.1}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}}}}};
    builder.node({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 7}}, {"scale", {2, 2, 2}}});
    builder.node({{"name", "plan"}, {"camera", 1}});
    const Loaded loaded(builder);
    ASSERT_TRUE(loaded.result.ok()) << loaded.error();
    ASSERT_EQ(loaded.scene().cameras.size(), 1u);
    const Camera& camera = loaded.scene().cameras[0];
    EXPECT_EQ(camera.name, "eye");
    EXPECT_EQ(camera.vertical_fov, 0.6f);
    EXPECT_EQ(camera.aspect, 1.5f);
    EXPECT_EQ(camera.transform.translation, (Vec3{0, 0, 7}));
    EXPECT_EQ(camera.transform.columns[2], (Vec3{0, 0, 1})) << "without the node's scale";
    EXPECT_EQ(loaded.notes("skipped-camera"), 1u);
}

}  // namespace
}  // namespace lumel
