// What a camera sees from behind, and beyond it.
#include "render/seen.h"

#include <gtest/gtest.h>

#include "render/picture.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

constexpr std::uint32_t kWidth = 9, kHeight = 5;

// A small wall that turns its back to the camera, before a large one that faces it.
Scene walls(bool double_sided) {
    test::SceneBuilder b;
    const auto near = b.material({0.5f, 0.5f, 0.5f}, {}, double_sided), far = b.material({0.5f, 0.5f, 0.5f});
    b.object("near", near, [](Mesh& m) { test::add_quad(m, {-0.2f, -0.2f, 0}, {0, 0.4f, 0}, {0.4f, 0, 0}); });
    b.object("far", far, [](Mesh& m) { test::add_quad(m, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0}); });
    return b.build();
}

SeenSurfaces see(const Scene& scene, bool through_backs, unsigned threads = 1) {
    Context context(threads);
    const test::TracedScene traced(scene, context);
    const Camera camera = look_at({0, 0, 2}, {0, 0, 0}, 0.8f);
    return see_surfaces(*traced.tracer, traced.geometry, camera, kWidth, kHeight, through_backs, context).value();
}

// The small wall is the triangles 0 and 1 of the scene.
std::size_t pixels_of_the_small_wall(const SeenSurfaces& seen) {
    std::size_t count = 0;
    for (const Hit& hit : seen.hits) count += hit.triangle < 2 ? 1 : 0;
    return count;
}

TEST(SeenSurfaces, BacksAreSeenOrLookedThrough) {
    const SeenSurfaces shown = see(walls(false), false), through = see(walls(false), true);
    ASSERT_EQ(shown.hits.size(), std::size_t{kWidth} * kHeight);
    // 0.4 of the 1.69 m that the picture is high at this distance: a fifth of it, as high as a pixel.
    EXPECT_GE(pixels_of_the_small_wall(shown), 1u);
    EXPECT_LE(pixels_of_the_small_wall(shown), 9u);
    EXPECT_TRUE(shown.hits[shown.hits.size() / 2].back_face);
    EXPECT_NEAR(shown.facing[shown.hits.size() / 2], 1.0f, 1e-6f);  // the middle of the picture, seen head on
    EXPECT_LT(shown.facing[0], 0.95f);
    EXPECT_EQ(pixels_of_the_small_wall(through), 0u);
    for (const Hit& hit : through.hits) EXPECT_FALSE(hit.missed());
    EXPECT_EQ(pixels_of_the_small_wall(see(walls(true), true)), pixels_of_the_small_wall(shown));
}

TEST(SeenSurfaces, SameBitsForAnyThreads) {
    const SeenSurfaces one = see(test::room(), true, 1), three = see(test::room(), true, 3);
    for (std::size_t i = 0; i < one.hits.size(); ++i) {
        EXPECT_EQ(one.hits[i].triangle, three.hits[i].triangle);
        EXPECT_EQ(one.hits[i].t, three.hits[i].t);
    }
}

}  // namespace
}  // namespace lumel
