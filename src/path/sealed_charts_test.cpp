#include "path/sealed_charts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/charted_scene.h"

namespace lumel {
namespace {

enum class Inside { nothing, lamp, slit };

// A floor under the sky; beside it the inside of a closed box, of which one can see nothing: dark, or with a lamp in
// it, or with a slit of a fiftieth of a side.
Scene floor_and_hollow(Inside inside) {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f}, {}, true);
    b.object("floor", grey, [](Mesh& m) { test::add_quad(m, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}); });
    b.object("hollow", grey, [&](Mesh& m) {
        test::add_box(m, {5, 0, 0}, {7, 2, 2}, true);
        if (inside != Inside::slit) return;
        // One wall anew, lower by the slit.
        m.triangles.erase(m.triangles.begin(), m.triangles.begin() + 2);
        test::add_quad(m, {5, 0, 0}, {0, 0, 2}, {0, 1.96f, 0});
    });
    if (inside == Inside::lamp) {
        Light& lamp = b.light(LightShape::point);
        lamp.position = {6, 1, 1};
        lamp.intensity = {1e-6f, 1e-6f, 1e-6f};  // however faint against the sky
    }
    b.scene().sky.color = {1, 1, 1};
    return b.build();
}

std::vector<std::vector<bool>> sealed_charts(Inside inside, double budget = 4000.0, unsigned threads = 2) {
    Context context(threads);
    const test::ChartedScene scene(floor_and_hollow(inside), 4, context);
    return find_sealed_charts(scene.charts, budget, scene.traced.transport, context).value();
}

std::ptrdiff_t count(const std::vector<bool>& charts) { return std::count(charts.begin(), charts.end(), true); }

TEST(SealedCharts, AreThoseInsideAHollow) {
    const auto sealed = sealed_charts(Inside::nothing);
    ASSERT_EQ(sealed.size(), 2u);
    EXPECT_EQ(count(sealed[0]), 0) << "the floor is lit";
    ASSERT_EQ(sealed[1].size(), 6u);
    EXPECT_EQ(count(sealed[1]), 6);
}

TEST(SealedCharts, ALampInsideHoweverFaintOpensIt) { EXPECT_EQ(count(sealed_charts(Inside::lamp)[1]), 0); }

TEST(SealedCharts, ASlitOpensIt) { EXPECT_EQ(count(sealed_charts(Inside::slit)[1]), 0); }

// 40 m^2 of surface: at a budget of 150 texels a side of 4 m^2 is worth 15.
TEST(SealedCharts, ThoseOfFewTexelsAreLeftAlone) {
    EXPECT_EQ(count(sealed_charts(Inside::nothing, 150.0)[1]), 0);
    EXPECT_EQ(count(sealed_charts(Inside::nothing, 180.0)[1]), 6);
}

TEST(SealedCharts, AreTheSameForAnyNumberOfThreads) {
    EXPECT_EQ(sealed_charts(Inside::slit, 4000.0, 1), sealed_charts(Inside::slit, 4000.0, 3));
}

TEST(SealedCharts, GetAQuarterOfTheDensityAndLeaveTheRestToOthers) {
    Context context(2);
    test::ChartedScene scene(floor_and_hollow(Inside::nothing), 4, context);
    ChartOptions options;
    options.texel_budget = 4000.0;
    const auto density = [&](const Atlas& atlas, std::size_t placement) {
        return static_cast<double>(atlas.placements[placement].scale.x);
    };
    const Atlas before = make_atlas(scene.traced.scene, scene.traced.geometry, scene.charts, options, context).value();
    scene.charts.sealed =
        find_sealed_charts(scene.charts, options.texel_budget, scene.traced.transport, context).value();
    const Atlas after = make_atlas(scene.traced.scene, scene.traced.geometry, scene.charts, options, context).value();
    // 16 m^2 of floor and 24 m^2 of hollow; the latter counts for a sixteenth: sqrt(40 / 17.5), less what borders take.
    EXPECT_NEAR(density(after, 0) / density(before, 0), 1.51, 0.05);
    EXPECT_NEAR(density(after, 1) / density(after, 0), 0.25, 0.02);
}

}  // namespace
}  // namespace lumel
