// No ray meets the triangle that it starts on, none misses an occluder four offsets away; the bound itself against
// double precision; the smooth position on a sphere.
#include "texel/ray_offset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/offset_rays.h"
#include "support/world_builder.h"

namespace lumel {
namespace {

using test::OffsetCase;
using test::Random;
using test::World;
using test::WorldBuilder;

// A million rays over all cases; ten million are in ray_offset_long_test.cpp.
TEST(RayOffset, NoRayMeetsItsOwnTriangle) {
    const auto count = test::trace_offset_rays(240, 300, 41);
    EXPECT_GT(count.rays, 900000u);
    EXPECT_GT(count.occluders, 500u);
    EXPECT_EQ(count.self_hits, 0u) << count.first_failure;
    EXPECT_EQ(count.missed_occluders, 0u) << count.first_failure;
}

// The height of the computed point above the exact plane, in double precision, stays below the bound, and the origin
// lies on the side asked for.
TEST(RayOffset, OriginLiesOnItsSide) {
    Random random(42);
    double largest_share = 0;
    for (const OffsetCase& c : test::offset_cases()) {
        const World world = test::offset_world(c, 2000, random);
        for (std::uint32_t t = 0; t < world.geometry.triangle_count(); ++t) {
            const auto [p0, p1, p2] = world.geometry.corners(t);
            const test::Plane plane(p0, p1, p2);
            if (!plane.defined()) continue;
            for (int i = 0; i < 10; ++i) {
                const Vec2 b = test::random_barycentrics(c, random);
                const Vec3 n = world.geometry.geometric_normal(t) * (i % 2 == 0 ? 1.0f : -1.0f);
                const double side = i % 2 == 0 ? 1.0 : -1.0;
                const double error = plane_error(world.geometry, t, b.x, b.y, n);
                const double height = plane.height(world.geometry.position(t, b.x, b.y));
                ASSERT_LE(std::fabs(height), error) << c.name << " triangle " << t;
                if (error > 0) largest_share = std::max(largest_share, std::fabs(height) / error);
                ASSERT_GT(side * plane.height(offset_origin(world.geometry, t, b.x, b.y, n)), 0.0)
                    << c.name << " triangle " << t;
            }
        }
    }
    // The bound is not loose by orders of magnitude.
    EXPECT_GT(largest_share, 0.2);
    EXPECT_LT(largest_share, 1.0);
}

// What the offset costs: a well-shaped triangle of 1 m at the origin moves its rays by microns.
TEST(RayOffset, OffsetIsSmall) {
    WorldBuilder builder;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0.8f, 0.5f, 0.1f}, {0.1f, 0.6f, 0.7f}};
    mesh.triangles = {{0, 1, 2}};
    builder.add_mesh(mesh);
    builder.add_quad({-10, 0, -10}, {0, 0, 20}, {20, 0, 0});  // a floor of 20 m, at height zero
    builder.add_quad({-10, 2, -10}, {0, 0, 20}, {20, 0, 0});  // the same 2 m up
    const World world = builder.build();
    const auto offset = [&](std::uint32_t t) {
        const Vec3 n = world.geometry.geometric_normal(t);
        return length(offset_origin(world.geometry, t, 0.3f, 0.3f, n) - world.geometry.position(t, 0.3f, 0.3f));
    };
    EXPECT_LT(offset(0), 5e-6f);
    EXPECT_LT(offset(1), 2e-6f);
    EXPECT_GT(offset(1), 0.0f);
    EXPECT_LT(offset(3), 4e-6f);
}

TEST(RayOffset, SliversAreBounded) {
    WorldBuilder builder;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.5f, 0.5000001f}};
    mesh.triangles = {{0, 1, 2}};
    builder.add_mesh(mesh);
    mesh.positions = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    builder.add_mesh(mesh);
    const World world = builder.build();
    EXPECT_LT(world.geometry.triangles[0].tracer_error, 0.005f);  // of a sliver of 1.7 m without breadth
    EXPECT_EQ(world.geometry.triangles[1].tracer_error, 0.0f);
}

TEST(SmoothPosition, RoundsOffASphere) {
    WorldBuilder builder;
    builder.add_icosphere({1, 2, 3}, 2.0f, 2);
    const World world = builder.build();
    Random random(43);
    double flat_error = 0, smooth_error = 0;
    for (std::uint32_t t = 0; t < world.geometry.triangle_count(); ++t)
        for (int i = 0; i < 50; ++i) {
            const Vec2 b = UniformTriangle::sample(random.pair());
            const Vec3 flat = world.geometry.position(t, b.x, b.y);
            const Vec3 smooth = smooth_position(world.geometry, t, b.x, b.y, false);
            const double below = 2.0 - length(flat - Vec3{1, 2, 3}), left = 2.0 - length(smooth - Vec3{1, 2, 3});
            flat_error += std::fabs(below);
            smooth_error += std::fabs(left);
            // Outward only; from inside (the back) the sphere is concave and stays where it is.
            EXPECT_GE(dot(smooth - flat, world.geometry.geometric_normal(t)), -1e-6f);
            EXPECT_NEAR(length(smooth_position(world.geometry, t, b.x, b.y, true) - flat), 0.0f, 1e-6f);
        }
    // The step is right to second order in the triangle's size; what is left is of fourth.
    EXPECT_LT(smooth_error, 0.05 * flat_error);
    EXPECT_GT(flat_error, 0.0);
}

// From smooth positions a convex mesh never gets into the way of the hemisphere of its vertex normals; from the flat
// ones it takes some 0.2 % of the light there.
TEST(SmoothPosition, ConvexMeshesDoNotShadeThemselves) {
    WorldBuilder builder;
    builder.add_icosphere({1, 2, 3}, 2.0f, 2);
    const World world = builder.build();
    Context context(1);
    const auto tracer = make_embree_tracer(world.geometry, world.surfaces(), context);
    ASSERT_TRUE(tracer.ok());
    Random random(44);
    std::vector<Ray> flat, smooth;
    for (int i = 0; i < 200000; ++i) {
        const std::uint32_t t = random.bits() % world.geometry.triangle_count();
        const Vec2 b = UniformTriangle::sample(random.pair());
        const Vec3 normal = world.geometry.shading_normal(t, b.x, b.y);
        const Vec3 direction = normalize(Frame(normal).to_world(CosineHemisphere::sample(random.pair())));
        const Vec3 origin = offset_origin(world.geometry, t, b.x, b.y, world.geometry.geometric_normal(t));
        const Vec3 move = smooth_position(world.geometry, t, b.x, b.y, false) - world.geometry.position(t, b.x, b.y);
        flat.push_back({origin, 0, direction});
        smooth.push_back({origin + move, 0, direction});
    }
    const auto count_blocked = [&](const std::vector<Ray>& rays) {
        std::vector<std::uint8_t> blocked(rays.size());
        (*tracer)->occluded(rays, blocked);
        return std::count(blocked.begin(), blocked.end(), std::uint8_t{1});
    };
    EXPECT_GT(count_blocked(flat), 100);
    EXPECT_EQ(count_blocked(smooth), 0);
}

TEST(SmoothPosition, FlatTrianglesStay) {
    WorldBuilder builder;
    builder.add_quad({0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0.2f});
    const World world = builder.build();
    EXPECT_EQ(smooth_position(world.geometry, 0, 0.2f, 0.3f, false), world.geometry.position(0, 0.2f, 0.3f));
}

// A vertex normal that points behind the face does not push the point through it.
TEST(SmoothPosition, NormalsBehindTheFaceDoNotCount) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {normalize({-1, -1, -0.2f}), {0, 0, 1}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    WorldBuilder builder;
    builder.add_mesh(mesh);
    const World world = builder.build();
    ASSERT_TRUE(world.geometry.triangles[0].flags & kCurved);
    EXPECT_GE(smooth_position(world.geometry, 0, 0.3f, 0.3f, false).z, 0.0f);
}

}  // namespace
}  // namespace lumel
