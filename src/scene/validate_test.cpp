// One fault at a time in a sound scene: each is found and named.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scene/world_geometry.h"
#include "support/scene_builder.h"

namespace lumel {
namespace {

Scene sound_scene() {
    test::SceneBuilder builder;
    const std::uint32_t material = builder.material({0.5f, 0.5f, 0.5f});
    builder.object("quad", material, [](Mesh& mesh) { test::add_quad(mesh, {}, {1, 0, 0}, {0, 1, 0}); });
    builder.texture({"t", 1, 1, true, {1, 2, 3, 4}});
    builder.light(LightShape::spot);
    Scene scene = builder.build();
    scene.cameras.emplace_back();
    return scene;
}

void edit_mesh(Scene& scene, const std::function<void(Mesh&)>& edit) {
    auto mesh = std::make_shared<Mesh>(*scene.meshes[0]);
    edit(*mesh);
    scene.meshes[0] = mesh;
}

TEST(Validate, AcceptsASoundScene) {
    const Status status = validate(sound_scene());
    EXPECT_TRUE(status.ok()) << status.error().text();
}

struct Fault {
    const char* expected;  // in the message
    std::function<void(Scene&)> make;
};

class ValidateFault : public testing::TestWithParam<Fault> {};

TEST_P(ValidateFault, IsNamed) {
    Scene scene = sound_scene();
    GetParam().make(scene);
    const Status status = validate(scene);
    ASSERT_FALSE(status.ok()) << GetParam().expected;
    EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
    EXPECT_NE(status.error().text().find(GetParam().expected), std::string::npos) << status.error().text();
}

const float kNan = std::nanf("");

INSTANTIATE_TEST_SUITE_P(
    All, ValidateFault,
    testing::Values(
        Fault{"no triangles", [](Scene& s) { s.instances.clear(), s.display.instances.clear(); }},
        Fault{"default", [](Scene& s) { s.materials.clear(); }},
        Fault{"vertex 2: the position is not finite",
              [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.positions[2].y = kNan; }); }},
        Fault{"vertex 1: the normal", [](Scene& s) { edit_mesh(s, [](Mesh& m) {
                                                         m.normals[1] = {0, 0, 2};
                                                     }); }},
        Fault{"UV 0 is not finite", [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.uv0[3].x = kNan; }); }},
        Fault{"another number of elements", [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.uv1.resize(3); }); }},
        Fault{"index 4 is out of range", [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.triangles[1][2] = 4; }); }},
        Fault{"reaches beyond", [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.primitives[0].triangle_count = 3; }); }},
        Fault{"outside its primitives", [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.primitives.clear(); }); }},
        Fault{"material index", [](Scene& s) { edit_mesh(s, [](Mesh& m) { m.primitives[0].material = 7; }); }},
        Fault{"mesh index", [](Scene& s) { s.instances[0].mesh = 1; }},
        Fault{"transform is not finite", [](Scene& s) { s.instances[0].transform.columns[1].x = kNan; }},
        Fault{"density", [](Scene& s) { s.instances[0].density_scale = 0; }},
        Fault{"base colour", [](Scene& s) { s.materials[0].base_color.x = 1.5f; }},
        Fault{"emission", [](Scene& s) { s.materials[0].emission.z = -1; }},
        Fault{"texture index", [](Scene& s) { s.materials[0].base_color_texture.texture = 1; }},
        Fault{"width * height * 4", [](Scene& s) { s.textures[0].width = 2; }},
        Fault{"intensity", [](Scene& s) { s.lights[0].intensity.x = kNan; }},
        Fault{"light 0 'light 0': intensity is 3e+38", [](Scene& s) { s.lights[0].intensity.y = 3e38f; }},
        Fault{"intensity times indirect scale",
              [](Scene& s) { s.lights[0].intensity.x = 1e9f, s.lights[0].indirect_scale = 1e6f; }},
        Fault{"material 0 'material 0': emission is 2e+12", [](Scene& s) { s.materials[0].emission.x = 2e12f; }},
        Fault{"lower --sky-intensity", [](Scene& s) { s.sky.color.z = 1e13f; }},
        Fault{"sky map: the brightest",
              [](Scene& s) {
                  s.sky.map = SkyMap{1, 1, {Vec3{0, 2e12f, 0}}};
              }},
        Fault{"unit length",
              [](Scene& s) {
                  s.lights[0].direction = {0, 0, -2};
              }},
        Fault{"inner <= outer", [](Scene& s) { s.lights[0].inner_cone = 1.0f; }},
        Fault{"no area", [](Scene& s) { s.lights[0].shape = LightShape::rectangle; }},
        Fault{"half_u x half_v",
              [](Scene& s) {
                  s.lights[0].shape = LightShape::disc;
                  s.lights[0].half_u = {1, 0, 0};
                  s.lights[0].half_v = {0, 1, 0};  // their product is +z, the light's direction -z
              }},
        Fault{"sphere light needs a radius", [](Scene& s) { s.lights[0].shape = LightShape::sphere; }},
        Fault{"sky", [](Scene& s) { s.sky.color.x = -1; }},
        Fault{"width * height",
              [](Scene& s) {
                  s.sky.map = SkyMap{2, 2, {}};
              }},
        Fault{"pixels",
              [](Scene& s) {
                  s.sky.map = SkyMap{1, 1, {Vec3{kNan, 0, 0}}};
              }},
        Fault{"field of view", [](Scene& s) { s.cameras[0].vertical_fov = 0; }},
        Fault{"baked instance", [](Scene& s) { s.display.instances[0].baked_instance = 5; }}));

TEST(Validate, TakesTheBrightestLight) {
    Scene scene = sound_scene();
    scene.lights[0].intensity = scene.materials[0].emission = scene.sky.color = Vec3{1, 1, 1} * kMaxRadiance;
    EXPECT_TRUE(validate(scene).ok());
}

TEST(Validate, LightingAloneIsAskedAboutLightsAndSky) {
    Scene scene = sound_scene();
    scene.materials.clear();
    EXPECT_TRUE(validate_lighting(scene).ok());
    scene.sky.color.x = 1e13f;
    EXPECT_FALSE(validate_lighting(scene).ok());
}

TEST(Validate, ErrorsNameTheSource) {
    Scene scene = sound_scene();
    scene.source = "room.glb";
    scene.instances[0].density_scale = -1;
    EXPECT_EQ(validate(scene).error().where.substr(0, 8), "room.glb");
}

}  // namespace
}  // namespace lumel
