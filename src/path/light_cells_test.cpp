#include "path/light_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/charted_scene.h"

namespace lumel {
namespace {

// The cells of a bake of so many samples.
struct LitScene {
    Context context{2};
    test::ChartedScene room;
    PathOptions path;
    SurfaceCells cells;

    LitScene(Scene scene, double texels_per_metre, std::uint32_t samples)
        : room(std::move(scene), texels_per_metre, context) {
        path.samples = samples;
        cells = make_lit_cells(room.charts, room.atlas, room.traced.transport, path, context).value();
    }

    RadianceSums gather(const SurfaceCells* with, std::uint64_t seed = 1) {
        PathOptions options = path;
        options.seed = seed;
        return room.gather(options, with);
    }
};

float total(const RadianceSums& sums, std::size_t i) {
    const Vec3 light = test::total_irradiance(sums, i);
    return (light.x + light.y + light.z) / 3.0f;
}

TEST(LightCells, TheirEdgeFallsWithTheRootOfTheSamples) {
    Atlas atlas;
    atlas.pages.push_back({512, 512});
    EXPECT_EQ(texels_per_cell(atlas, 256), 2.8);
    EXPECT_EQ(texels_per_cell(atlas, 1024), 1.4);
    EXPECT_EQ(texels_per_cell(atlas, 1u << 20), 1.0);
    EXPECT_EQ(texels_per_cell(atlas, 1), 8.0);
    atlas.pages.assign(10, {4000, 4000});
    EXPECT_EQ(texels_per_cell(atlas, 4096), 20.0);  // 400,000 cells
}

// Radiance 2 everywhere, so irradiance 2 pi, of which a cell gets half from the walls' own light and half from bounces.
TEST(LightCells, AWhiteFurnaceIsEvenInEveryCell) {
    test::SceneBuilder b;
    const auto glowing = b.material({0.5f, 0.5f, 0.5f}, {1, 1, 1});
    b.object("box", glowing, [](Mesh& m) { test::add_box(m, {0, 0, 0}, {2, 2, 2}, true); });
    LitScene lit(b.build(), 16, 256);
    ASSERT_GT(lit.cells.size(), 100u);
    double mean = 0.0;
    for (std::uint32_t i = 0; i < lit.cells.size(); ++i) {
        ASSERT_TRUE(lit.cells.usable(i)) << i;
        // 128 paths of GatherHemisphere: cos/(1/2 + cos) has a relative deviation of 0.24, stratified far less than
        // 0.24/sqrt(128); links add theirs.
        ASSERT_NEAR(lit.cells.irradiance(i).x, 2.0f, 0.1f) << i;
        mean += static_cast<double>(lit.cells.irradiance(i).x);
    }
    EXPECT_NEAR(mean / static_cast<double>(lit.cells.size()), 2.0, 0.004);
    const RadianceSums sums = lit.gather(&lit.cells);
    for (std::size_t i = 0; i < sums.size(); ++i) ASSERT_NEAR(total(sums, i), 2.0f, 0.1f) << i;
}

TEST(LightCells, AgreeWithBruteForceInTheMean) {
    LitScene lit(test::room(), 8, 256);
    const RadianceSums with = lit.gather(&lit.cells), without = lit.gather(nullptr, 2);
    double a = 0.0, b = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < with.size(); ++i) {
        if (!with.valid(i) || !without.valid(i)) continue;
        a += static_cast<double>(total(with, i));
        b += static_cast<double>(total(without, i));
        for (const RadianceSums* s : {&with, &without})
            for (std::size_t c = 0; c < 3; ++c) variance += static_cast<double>(s->variance[i][c]) / 3.0;
    }
    // Cells of half a metre in a room of three: a percent, on top of four deviations of the noise (of channels that go
    // together, which is the worst).
    EXPECT_NEAR(a / b, 1.0, 0.01 + 4.0 * std::sqrt(variance) / b);
}

TEST(LightCells, EndPathsInsteadOfFollowingThem) {
    LitScene lit(test::room(), 8, 256);
    const auto rays = [&](const SurfaceCells* with) {
        const std::uint64_t before = lit.room.traced.tracer->statistics().rays;
        lit.gather(with);
        return static_cast<double>(lit.room.traced.tracer->statistics().rays - before);
    };
    EXPECT_LT(rays(&lit.cells), 0.8 * rays(nullptr));
}

struct Wall {
    const char* name;
    float thickness;  // 0: one double-sided quad
};

// Two rooms over one floor, one of them with a lamp: nothing of it comes through the wall between them.
class LightCellsLeak : public testing::TestWithParam<Wall> {};

TEST_P(LightCellsLeak, NoLightComesThroughAWall) {
    const float thickness = GetParam().thickness;
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f});
    const auto sheet = b.material({0.8f, 0.8f, 0.8f}, {}, true);
    const auto lamp = b.material({0, 0, 0}, {20, 20, 20});
    b.object("rooms", white, [](Mesh& m) { test::add_box(m, {0, 0, 0}, {4, 2, 2}, true); });
    if (thickness > 0.0f)
        b.object("wall", white, [&](Mesh& m) {
            test::add_box(m, {2.03f - 0.5f * thickness, 0, 0}, {2.03f + 0.5f * thickness, 2, 2}, false);
        });
    else
        b.object("wall", sheet, [](Mesh& m) { test::add_quad(m, {2.03f, 0, 0}, {0, 2, 0}, {0, 0, 2}); });
    b.object("lamp", lamp, [](Mesh& m) { test::add_quad(m, {0.5f, 1.9f, 0.5f}, {1, 0, 0}, {0, 0, 1}); });
    LitScene lit(b.build(), 8, 256);
    const RadianceSums sums = lit.gather(&lit.cells);
    double bright = 0.0;
    std::size_t count = 0;
    const float edge = 0.125f, side = 2.03f + 0.5f * thickness;
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (lit.room.texels.position[i].x < 1.5f) {
            bright += static_cast<double>(total(sums, i));
            ++count;
        }
    bright /= static_cast<double>(count);
    ASSERT_GT(bright, 1.0);
    std::size_t dark = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        // Texels that the wall stands on lie in both rooms.
        if (lit.room.texels.position[i].x < side + edge || !sums.valid(i)) continue;
        ASSERT_LE(static_cast<double>(total(sums, i)), 0.01 * bright)
            << lit.room.texels.position[i].x << ' ' << lit.room.texels.position[i].y << ' '
            << lit.room.texels.position[i].z;
        ++dark;
    }
    EXPECT_GT(dark, 500u);
}

// Cells before the back of a wall bounce what the sun brings them, and no more: their paths that meet it are black and
// count.
TEST(LightCells, ABackDoesNotBrightenThem) {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f});
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {-2, 0, 1}, {2, 0, 0}, {0, 0, -2}); });
    b.object("screen", white, [](Mesh& m) {
        test::add_quad(m, {-2, 0, 1}, {0, 0, -2}, {0, 1, 0});
    });  // faces the floor
    b.object(
        "wall", white,
        [](Mesh& m) {
            test::add_quad(m, {0, 0, 1}, {0, 0, -2}, {0, 3, 0});
        },
        {}, NodeClass::occluder);
    Light& sun = b.light(LightShape::sun);
    sun.direction = {0, -1, 0};
    sun.intensity = {3, 3, 3};
    LitScene lit(b.build(), 8, 256);
    const RadianceSums with = lit.gather(&lit.cells), without = lit.gather(nullptr);
    double sum_with = 0.0, sum_without = 0.0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
        if (lit.room.texels.position[i].y < 0.05f || !with.valid(i) || !without.valid(i)) continue;  // of the screen
        sum_with += static_cast<double>(total(with, i));
        sum_without += static_cast<double>(total(without, i));
        ++compared;
    }
    ASSERT_GT(compared, 80u);
    // More than eighty texels of 256 samples; were the first cells before the wall half as bright again, 3 % more.
    EXPECT_NEAR(sum_with / sum_without, 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Walls, LightCellsLeak,
                         testing::Values(Wall{"solid_100mm", 0.1f}, Wall{"solid_20mm", 0.02f}, Wall{"sheet", 0.0f}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace lumel
