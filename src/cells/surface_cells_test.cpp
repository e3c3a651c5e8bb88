#include "cells/surface_cells.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "support/scene_builder.h"

namespace lumel {
namespace {

// A floor of 4 x 4 m in the plane y = 0, triangles 0 and 1, with what stands on it; cells of half a metre.
struct Floor {
    Context context{1};
    Scene scene;
    WorldGeometry geometry;
    std::unique_ptr<Tracer> tracer;
    ChartSet charts;
    SurfaceCells cells;

    explicit Floor(test::SceneBuilder builder) : scene(builder.build()), geometry(flatten(scene, context).value()) {
        tracer = make_embree_tracer(geometry, SurfaceReader(scene, geometry), context).value();
        ChartOptions layout;
        layout.uv1 = Uv1Policy::ignore;
        layout.texels_per_metre = 8;
        charts = make_charts(scene, geometry, layout, context).value();
        const Atlas atlas = make_atlas(scene, geometry, charts, layout, context).value();
        cells = SurfaceCells::make(scene, geometry, charts, atlas, *tracer, 4.0, context).value();
    }
    // The cell below a point of the floor.
    [[nodiscard]] std::uint32_t at(float x, float z, bool back = false, Vec2 jitter = {0.5f, 0.5f}) const {
        const auto place = place_of(x, z, back);
        return place.home == kNone ? kNone : cells.pick(place, jitter);
    }
    [[nodiscard]] SurfaceCells::Place place_of(float x, float z, bool back = false) const {
        // Corners (0,0), (4,0), (4,4) and (0,0), (4,4), (0,4) in (x, z) turned: see add_floor.
        const float u = x / 4.0f, v = 1.0f - z / 4.0f;
        return u >= v ? cells.find(0, u - v, v, back) : cells.find(1, u, v - u, back);
    }
};

test::SceneBuilder floor_builder(bool double_sided = false) {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f}, {}, double_sided);
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 4}, {4, 0, 0}, {0, 0, -4}); });
    return b;
}

TEST(SurfaceCells, AFlatFloorIsCellsThroughout) {
    const Floor floor(floor_builder());
    // Charts reach from the middle of their first texel to that of their last: 8 steps of half a metre, 9 cells.
    EXPECT_EQ(floor.cells.size(), 81u);
    for (float x = 0.05f; x < 4.0f; x += 0.1f)
        for (float z = 0.05f; z < 4.0f; z += 0.1f) ASSERT_NE(floor.at(x, z), kNone) << x << ' ' << z;
    EXPECT_NEAR(floor.cells.edge(0), 0.5f, 0.01f);
}

TEST(SurfaceCells, ASingleSidedFloorHasNoCellsBelow) {
    EXPECT_EQ(Floor(floor_builder()).at(1, 1, true), kNone);
    const Floor sheet(floor_builder(true));
    EXPECT_EQ(sheet.cells.size(), 162u);
    const std::uint32_t below = sheet.at(1, 1, true);
    ASSERT_NE(below, kNone);
    EXPECT_NE(below, sheet.at(1, 1));
    EXPECT_TRUE(sheet.cells.is_back(below));
}

TEST(SurfaceCells, InterpolationIsTheMeanOfPicks) {
    Floor floor(floor_builder());
    std::vector<CellGather> gathers(floor.cells.size());
    for (std::size_t i = 0; i < gathers.size(); ++i)
        gathers[i] = {{static_cast<float>(i % 7), static_cast<float>(i % 5), 1.0f}, 1, 1};
    ASSERT_TRUE(floor.cells.solve(gathers, {}, 1, floor.context).ok());
    for (const auto& [x, z] : {std::pair{1.1f, 1.2f}, {0.02f, 3.97f}, {2.4f, 0.3f}}) {
        const SurfaceCells::Place place = floor.place_of(x, z);
        Vec3 mean{};
        for (int i = 0; i < 100; ++i)
            for (int j = 0; j < 100; ++j)
                mean += floor.cells.irradiance(floor.cells.pick(
                            place, {(static_cast<float>(i) + 0.5f) * 0.01f, (static_cast<float>(j) + 0.5f) * 0.01f})) *
                        1e-4f;
        // A hundred steps each way; neighbours differ by up to 6.
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(floor.cells.irradiance(place)[c], mean[c], 2 * 6 * 0.01f);
        EXPECT_NEAR(floor.cells.irradiance(place).z, 1.0f, 1e-5f);
    }
}

TEST(SurfaceCells, JitterPicksTheNearestCells) {
    const Floor floor(floor_builder());
    // Middles of cells lie at multiples of 0.5: (1.1, 1.0) is a fifth of the way to the next in x, which a fifth of the
    // jitters find. Charts may be turned: which of the two coordinates runs along x is for them to say.
    const std::uint32_t here = floor.at(1.0f, 1.0f), next = floor.at(1.5f, 1.0f);
    ASSERT_NE(here, next);
    int found = 0;
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 100; ++j) {
            const Vec2 jitter{(static_cast<float>(i) + 0.5f) * 0.01f, (static_cast<float>(j) + 0.5f) * 0.01f};
            const std::uint32_t cell = floor.at(1.1f, 1.0f, false, jitter);
            ASSERT_TRUE(cell == here || cell == next);
            found += cell == next;
        }
    EXPECT_NEAR(found, 2000, 101);  // a row of the jitters, for rounding
}

// A wall along x = 2.25, between the cells of 2.0 and 2.5.
test::SceneBuilder with_wall(float x) {
    test::SceneBuilder b = floor_builder();
    const auto sheet = b.material({0.8f, 0.8f, 0.8f}, {}, true);
    b.object(
        "wall", sheet,
        [x](Mesh& m) {
            test::add_quad(m, {x, 0, 0}, {0, 2, 0}, {0, 0, 4});
        },
        {}, NodeClass::volume);
    return b;
}

TEST(SurfaceCells, JitterDoesNotReachThroughAWall) {
    const Floor open(floor_builder()), walled(with_wall(2.25f));
    const auto reaches_beyond = [](const Floor& floor) {
        const std::uint32_t near = floor.at(2.2f, 1.0f), beyond = floor.at(2.3f, 1.0f);
        EXPECT_NE(near, beyond);
        EXPECT_NE(near, kNone);
        EXPECT_NE(beyond, kNone);
        for (int i = 0; i < 10; ++i)
            for (int j = 0; j < 10; ++j)
                if (floor.at(2.2f, 1.0f, false, {static_cast<float>(i) * 0.1f, static_cast<float>(j) * 0.1f}) == beyond)
                    return true;
        return false;
    };
    EXPECT_TRUE(reaches_beyond(open));
    EXPECT_FALSE(reaches_beyond(walled));
}

TEST(SurfaceCells, WhereAWallStandsThereIsNoCell) {
    const Floor walled(with_wall(2.05f));
    EXPECT_EQ(walled.at(2.1f, 1.0f), kNone);
    EXPECT_EQ(walled.at(1.9f, 1.0f), kNone);
    EXPECT_NE(walled.at(2.6f, 1.0f), kNone);
    EXPECT_NE(walled.at(1.4f, 1.0f), kNone);
}

// Two cells that see only each other: each iteration is a bounce of the geometric series.
TEST(SurfaceCells, BouncesAreIterationsOverTheLinks) {
    Floor floor(floor_builder());
    const std::size_t n = floor.cells.size();
    std::vector<CellGather> gathers(n, CellGather{{1, 2, 0}, 2, 2});
    std::vector<CellLink> links(n);
    // One path of the two ends at the other cell, with half of its light: a quarter of it in the mean.
    for (std::size_t i = 0; i < n; ++i) links[i] = {static_cast<std::uint32_t>(i ^ 1u) % 81u, {16384, 16384, 16384}};
    ASSERT_TRUE(floor.cells.solve(gathers, links, 3, floor.context).ok());
    EXPECT_FLOAT_EQ(floor.cells.irradiance(5).x, 1.0f + 0.25f + 0.0625f);
    ASSERT_TRUE(floor.cells.solve(gathers, links, 64, floor.context).ok());
    EXPECT_NEAR(floor.cells.irradiance(5).y, 2.0f / 0.75f, 1e-4f);  // stops at a change of 1e-5
    EXPECT_EQ(floor.cells.irradiance(5).z, 0.0f);
}

// A bright group that has all its light at once, and a dim pair whose light takes many bounces.
TEST(SurfaceCells, DimCellsBounceToTheirEndBesideBrightOnes) {
    Floor floor(floor_builder());
    const std::size_t n = floor.cells.size();
    std::vector<CellGather> gathers(n, CellGather{{1e6f, 1e6f, 1e6f}, 1, 1});
    std::vector<CellLink> links(n);
    gathers[0].direct = gathers[1].direct = {1, 1, 1};
    const auto weight = static_cast<std::uint16_t>(0.8f * CellLink::kOne);
    links[0] = {1, {weight, weight, weight}};
    links[1] = {0, {weight, weight, weight}};
    ASSERT_TRUE(floor.cells.solve(gathers, links, 64, floor.context).ok());
    EXPECT_NEAR(floor.cells.irradiance(0).x, 5.0f, 0.01f);  // 1/(1 - 0.8); the last changes are 1e-5 of it
}

TEST(SurfaceCells, ACellAmongBacksStillPassesItsLightOn) {
    Floor floor(floor_builder());
    const std::size_t n = floor.cells.size();
    std::vector<CellGather> gathers(n, CellGather{{}, 4, 4});
    std::vector<CellLink> links(n);
    gathers[1] = {{1, 1, 1}, 1, 4};
    links[0] = {1, {32768, 32768, 32768}};
    ASSERT_TRUE(floor.cells.solve(gathers, links, 8, floor.context).ok());
    EXPECT_FALSE(floor.cells.usable(1));
    EXPECT_FLOAT_EQ(floor.cells.irradiance(0).x, 0.25f);
}

TEST(SurfaceCells, LightThatIsNoNumberStaysOut) {
    Floor floor(floor_builder());
    const std::size_t n = floor.cells.size();
    std::vector<CellGather> gathers(n, CellGather{{1, 1, 1}, 1, 1});
    std::vector<CellLink> links(n, CellLink{3, {16384, 16384, 16384}});
    gathers[3].direct.x = std::numeric_limits<float>::infinity();
    ASSERT_TRUE(floor.cells.solve(gathers, links, 4, floor.context).ok());
    EXPECT_FALSE(floor.cells.usable(3));
    for (std::uint32_t i = 0; i < n; ++i) EXPECT_TRUE(is_finite(floor.cells.irradiance(i))) << i;
}

TEST(SurfaceCells, WhereASlabLiesThereIsNoCell) {
    test::SceneBuilder b = floor_builder();
    const auto white = b.material({0.8f, 0.8f, 0.8f});
    // A centimetre above the floor, lower than what the cells' middles are lifted by.
    b.object(
        "slab", white,
        [](Mesh& m) {
            test::add_box(m, {1.6f, 0.01f, 0}, {4, 0.015f, 4}, false);
        },
        {}, NodeClass::volume);
    const Floor floor(std::move(b));
    EXPECT_EQ(floor.at(1.4f, 1.0f), kNone);  // its edge is in this one
    EXPECT_NE(floor.at(0.9f, 1.0f), kNone);
}

TEST(SurfaceCells, ACellAmongBacksOfSurfacesIsNone) {
    Floor floor(floor_builder());
    std::vector<CellGather> gathers(floor.cells.size(), CellGather{{1, 1, 1}, 10, 10});
    const std::uint32_t cell = floor.at(1, 1);
    gathers[cell].open = 4;
    ASSERT_TRUE(floor.cells.solve(gathers, {}, 2, floor.context).ok());
    EXPECT_EQ(floor.at(1, 1), kNone);
    EXPECT_NE(floor.at(2, 2), kNone);
}

}  // namespace
}  // namespace lumel
