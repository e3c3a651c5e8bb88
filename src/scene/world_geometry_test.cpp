// Flattening, its queries and the hash of a scene.
#include "scene/world_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scene_builder.h"

namespace lumel {
namespace {

using test::SceneBuilder;

Affine scaled(Vec3 scale, Vec3 translation = {}) {
    return {{Vec3{scale.x, 0, 0}, Vec3{0, scale.y, 0}, Vec3{0, 0, scale.z}}, translation};
}

WorldGeometry flattened(const Scene& scene) {
    Context context(1);
    return std::move(flatten(scene, context)).value();
}

void fill_quad(Mesh& mesh) { test::add_quad(mesh, {}, {2, 0, 0}, {0, 3, 0}); }

Scene quad_scene(const Affine& transform, NodeClass node_class = NodeClass::lightmap) {
    SceneBuilder builder;
    builder.object("quad", builder.material({0.5f, 0.5f, 0.5f}), fill_quad, transform, node_class);
    return builder.build();
}

TEST(Flatten, PlacesInstancesOneAfterTheOther) {
    SceneBuilder builder;
    const std::uint32_t material = builder.material({1, 1, 1});
    builder.object("a", material, fill_quad, scaled({1, 1, 1}, {10, 0, 0}));
    builder.instance("b", 0, scaled({1, 1, 1}, {0, 20, 0}), NodeClass::probe);
    builder.instance("c", 0, scaled({1, 1, 1}, {0, 0, 30}), NodeClass::volume);
    const WorldGeometry geometry = flattened(builder.build());
    ASSERT_EQ(geometry.triangle_count(), 4u);
    EXPECT_EQ(geometry.first_triangle, (std::vector<std::uint32_t>{0, 2, 2, 4}));
    EXPECT_EQ(geometry.triangles[2].instance, 2u);
    EXPECT_EQ(geometry.triangles[3].mesh_triangle, 1u);
    EXPECT_EQ(geometry.corners(0)[0], (Vec3{10, 0, 0}));
    EXPECT_EQ(geometry.corners(2)[1], (Vec3{2, 0, 30}));
    EXPECT_EQ(geometry.bounds_min, (Vec3{0, 0, 0}));
    EXPECT_EQ(geometry.bounds_max, (Vec3{12, 3, 30}));
}

TEST(Flatten, AbsentMaterialIsTheDefaultOne) {
    SceneBuilder builder;
    builder.material({1, 0, 0});
    builder.object("quad", kNone, fill_quad);
    EXPECT_EQ(flattened(builder.build()).triangles[0].material, 1u);
}

TEST(Flatten, MirroredInstancesKeepTheirOuterSide) {
    const WorldGeometry geometry = flattened(quad_scene(scaled({-1, 1, 1})));
    EXPECT_TRUE(geometry.triangles[0].flags & kMirrored);
    // The quad's front is +z; mirroring x leaves it there although the corners now turn the other way.
    EXPECT_EQ(geometry.geometric_normal(0), (Vec3{0, 0, 1}));
    EXPECT_EQ(geometry.shading_normal(0, 0.3f, 0.3f), (Vec3{0, 0, 1}));
    EXPECT_EQ(flattened(quad_scene(scaled({1, 1, -1}))).geometric_normal(0), (Vec3{0, 0, -1}));
}

TEST(Flatten, NormalsFollowTheInverseTranspose) {
    SceneBuilder builder;
    builder.object(
        "slope", builder.material({1, 1, 1}),
        [](Mesh& mesh) {
            test::add_quad(mesh, {}, {1, 1, 0}, {0, 0, -1});
        },
        scaled({2, 1, 1}));
    const WorldGeometry geometry = flattened(builder.build());
    // In the world the slope rises 1 on 2: its normal is (-1, 2, 0) / sqrt 5.
    const float expected_x = -1.0f / std::sqrt(5.0f);
    EXPECT_NEAR(geometry.normals[0].x, expected_x, 1e-6f);
    EXPECT_NEAR(geometry.geometric_normal(0).x, expected_x, 1e-6f);
    EXPECT_FALSE(geometry.triangles[0].flags & kCurved) << "vertex and face normals agree";
}

TEST(Flatten, FlagsSayWhatTheMaterialIs) {
    const auto flags = [](auto&& edit) {
        SceneBuilder builder;
        const std::uint32_t material = builder.material({1, 1, 1});
        builder.object("quad", material, fill_quad);
        edit(builder, builder.material_at(material));
        return int{flattened(builder.build()).triangles[0].flags};
    };
    EXPECT_EQ(flags([](SceneBuilder&, Material&) {}), 0);
    EXPECT_EQ(flags([](SceneBuilder&, Material& m) { m.double_sided = true; }), int{kDoubleSided});
    EXPECT_EQ(flags([](SceneBuilder&, Material& m) { m.emission = {0, 1, 0}; }), int{kEmissive});
    EXPECT_EQ(flags([](SceneBuilder&, Material& m) { m.alpha_mode = AlphaMode::blend; }), 0) << "alpha is 1";
    EXPECT_EQ(flags([](SceneBuilder&, Material& m) { m.alpha_mode = AlphaMode::blend, m.alpha = 0.9f; }),
              int{kNeedsAlpha});
    EXPECT_EQ(flags([](SceneBuilder&, Material& m) { m.alpha_mode = AlphaMode::mask, m.alpha = 0.4f; }),
              int{kNeedsAlpha});
    EXPECT_EQ(flags([](SceneBuilder&, Material& m) { m.alpha_mode = AlphaMode::mask, m.alpha = 0.6f; }), 0);
    EXPECT_EQ(flags([](SceneBuilder& b, Material& m) {
                  m.alpha_mode = AlphaMode::mask;
                  m.base_color_texture.texture = b.texture({"t", 2, 1, true, {9, 9, 9, 255, 9, 9, 9, 0}});
              }),
              int{kNeedsAlpha});
    EXPECT_EQ(flags([](SceneBuilder& b, Material&) { b.scene().instances[0].node_class = NodeClass::occluder; }),
              int{kOccluderOnly});
}

TEST(Flatten, SmoothVerticesMakeATriangleCurved) {
    SceneBuilder builder;
    builder.object("quad", builder.material({1, 1, 1}), [](Mesh& mesh) {
        fill_quad(mesh);
        mesh.normals[1] = normalize(Vec3{0.1f, 0, 1});
    });
    const WorldGeometry geometry = flattened(builder.build());
    EXPECT_TRUE(geometry.triangles[0].flags & kCurved);
    EXPECT_FALSE(geometry.triangles[1].flags & kCurved) << "it does not touch vertex 1";
}

TEST(Flatten, CountsAndKeepsZeroAreaTriangles) {
    SceneBuilder builder;
    builder.object("sliver", builder.material({1, 1, 1}), [](Mesh& mesh) {
        fill_quad(mesh);
        mesh.positions[3] = mesh.positions[2];
    });
    const Scene scene = builder.build();
    Context context(1);
    const WorldGeometry geometry = std::move(flatten(scene, context)).value();
    EXPECT_EQ(context.diagnostics.count("zero-area-triangle"), 1u);
    EXPECT_EQ(geometry.triangle_count(), 2u);
    EXPECT_EQ(geometry.geometric_normal(1), Vec3{});
    EXPECT_EQ(geometry.area(1), 0.0f);
    EXPECT_NEAR(length(geometry.shading_normal(1, 0.2f, 0.2f)), 1.0f, 1e-6f);
}

TEST(Flatten, RefusesWhatLeavesTheRangeOfFloat) {
    const Scene scene = quad_scene(scaled({3e38f, 1, 1}));
    Context context(1);
    const Result<WorldGeometry> geometry = flatten(scene, context);
    ASSERT_FALSE(geometry.ok());
    EXPECT_NE(geometry.error().text().find("quad"), std::string::npos) << geometry.error().text();
    EXPECT_NE(geometry.error().text().find("vertex 1"), std::string::npos) << geometry.error().text();
}

// A small triangle far out and a large one at the origin: the same shape at 17 scales.
TEST(WorldGeometry, NormalAndAreaHoldAtAnyScale) {
    for (float scale = 1e-9f; scale < 2e7f; scale *= 10.0f) {
        const WorldGeometry geometry = flattened(quad_scene(scaled({scale, scale, scale})));
        EXPECT_EQ(geometry.geometric_normal(0), (Vec3{0, 0, 1})) << scale;
        EXPECT_NEAR(geometry.area(0) / (3.0f * scale * scale), 1.0f, 1e-6f) << scale;
    }
}

TEST(WorldGeometry, ShadingNormalNeverPointsBehindTheFace) {
    SceneBuilder builder;
    builder.object("quad", builder.material({1, 1, 1}), [](Mesh& mesh) {
        fill_quad(mesh);
        mesh.normals[0] = {0, 0, -1};
    });
    const WorldGeometry geometry = flattened(builder.build());
    EXPECT_EQ(geometry.shading_normal(0, 0.1f, 0.1f), (Vec3{0, 0, 1})) << "the file's normal is behind: the face's";
    EXPECT_EQ(geometry.shading_normal(0, 0.4f, 0.4f), (Vec3{0, 0, 1}));
}

TEST(WorldGeometry, ShadingNormalInterpolates) {
    SceneBuilder builder;
    builder.object("quad", builder.material({1, 1, 1}), [](Mesh& mesh) {
        fill_quad(mesh);
        mesh.normals[0] = normalize(Vec3{-1, 0, 1});
        mesh.normals[1] = normalize(Vec3{1, 0, 1});
    });
    const WorldGeometry geometry = flattened(builder.build());
    const Vec3 middle = geometry.shading_normal(0, 0.5f, 0.0f);
    EXPECT_NEAR(middle.x, 0.0f, 1e-6f);
    EXPECT_NEAR(middle.z, 1.0f, 1e-6f);
    EXPECT_EQ(geometry.position(0, 0.5f, 0.0f), (Vec3{1, 0, 0}));
}

TEST(HashScene, ChangesWithEverythingThatABakeDependsOn) {
    const auto make = [](auto&& edit) {
        SceneBuilder builder;
        const std::uint32_t material = builder.material({0.5f, 0.5f, 0.5f});
        builder.object("quad", material, fill_quad);
        builder.light(LightShape::point);
        builder.texture({"t", 1, 1, true, {1, 2, 3, 4}});
        Scene scene = builder.build();
        edit(scene);
        return hash_scene(scene);
    };
    const Hash128 plain = make([](Scene&) {});
    EXPECT_EQ(plain, make([](Scene&) {}));
    EXPECT_EQ(plain, make([](Scene& s) { s.instances[0].name = "other"; })) << "names light nothing";
    const Hash128 changed[] = {
        make([](Scene& s) { s.materials[0].base_color.y = 0.25f; }),
        make([](Scene& s) { s.materials[0].double_sided = true; }),
        make([](Scene& s) { s.materials[0].emission_texture.texture = 0; }),
        make([](Scene& s) { s.textures[0].rgba[2] = 4; }),
        make([](Scene& s) { s.instances[0].transform.translation.x = 1; }),
        make([](Scene& s) { s.instances[0].node_class = NodeClass::volume; }),
        make([](Scene& s) { s.instances[0].density_scale = 2; }),
        make([](Scene& s) { s.lights[0].radius = 0.1f; }),
        make([](Scene& s) { s.lights[0].bake = LightBake::none; }),
        make([](Scene& s) { s.lights.push_back(s.lights[0]); }),
        make([](Scene& s) {
            s.sky.color = {1, 1, 1};
        }),
        make([](Scene& s) {
            s.sky.map = SkyMap{2, 1, {Vec3{}, Vec3{}}};
        }),
        make([](Scene& s) {
            auto mesh = std::make_shared<Mesh>(*s.meshes[0]);
            mesh->uv0[2].x = 0.5f;
            s.meshes[0] = mesh;
        }),
    };
    for (std::size_t i = 0; i < std::size(changed); ++i) {
        EXPECT_NE(plain, changed[i]) << "change " << i;
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(changed[i], changed[j]) << i << " and " << j;
    }
}

}  // namespace
}  // namespace lumel
