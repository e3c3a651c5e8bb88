#include "bake/memory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/memory_use.h"
#include "support/meshes.h"
#include "support/scene_builder.h"
#include "trace/tracer.h"

namespace lumel {
namespace {

Scene field(std::uint32_t cells, Vec3 emission) {
    test::SceneBuilder b;
    const auto material = b.material({0.8f, 0.8f, 0.8f});
    b.object("field", material, [&](Mesh& m) {
        m = test::flat_grid(cells, 10.0f);
        m.primitives.clear();  // the builder adds one
    });
    Scene scene = b.build();
    scene.materials[material].emission = emission;
    return scene;
}

TEST(Memory, EmissiveTrianglesAreLights) {
    Context context(1);
    const Scene dark = field(100, {}), bright = field(100, {1, 1, 1});
    const WorldGeometry dark_world = flatten(dark, context).value(), bright_world = flatten(bright, context).value();
    EXPECT_EQ(light_memory(dark_world), 0u);
    EXPECT_GE(light_memory(bright_world), 20000u * 276u);
    EXPECT_EQ(scene_memory(bright, bright_world, {}) - scene_memory(dark, dark_world, {}), light_memory(bright_world));
}

// Bakes that leave seams as they are pay nothing for them; others for the page, for later pages, and for the search.
TEST(Memory, SeamsAreForBakesThatMakeThemEqual) {
    Context context(1);
    const Scene scene = field(10, {});
    const WorldGeometry geometry = flatten(scene, context).value();
    Atlas atlas;
    atlas.first_placement = {0, 0};
    atlas.pages = {{512, 512}};
    const std::uint64_t off = bake_memory(scene, geometry, atlas, {}, 1);
    const std::uint64_t on = bake_memory(scene, geometry, atlas, {0, 1000, false}, 1);
    const std::uint64_t solving = page_memory({512, 512}, 0, true, 1) - page_memory({512, 512}, 0, false, 1);
    EXPECT_GT(solving, 512u * 512u * 100u);
    EXPECT_EQ(on - off, solving + seam_memory(1000, atlas).samples);
    // Millions of edges take more than the page.
    EXPECT_GT(bake_memory(scene, geometry, atlas, {0, 10'000'000, false}, 1) - off, 10'000'000u * 250u);
    const std::uint64_t one_page = seam_memory(1000, atlas).samples;
    atlas.pages.push_back({512, 512});
    EXPECT_GT(seam_memory(1000, atlas).samples, 4 * one_page) << "what a page showed is remembered for later ones";
}

// What is said to be needed is near what is: not less, and not twice as much.
TEST(Memory, TheTracerTakesWhatIsPredicted) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take memory of their own";
#endif
    Context context(1);
    const Scene scene = field(400, {});
    const WorldGeometry geometry = flatten(scene, context).value();
    ASSERT_EQ(geometry.triangle_count(), 320000u);
    // The high-water mark falls to what is taken now.
    if (!(std::ofstream("/proc/self/clear_refs") << "5" << std::flush)) GTEST_SKIP() << "the peak cannot be reset";
    const double before = static_cast<double>(peak_memory());
    const auto tracer = make_embree_tracer(geometry, SurfaceReader(scene, geometry), context);
    ASSERT_TRUE(tracer.ok());
    const double taken = static_cast<double>(peak_memory()) - before;
    const auto predicted = static_cast<double>(tracer_memory(geometry));
    EXPECT_LT(taken, predicted + 8e6) << "the library itself";
    EXPECT_GT(taken, 0.75 * predicted) << "pages that earlier tests let go are taken again";
}

}  // namespace
}  // namespace lumel
