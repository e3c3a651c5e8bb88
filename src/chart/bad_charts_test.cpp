#include "chart/bad_charts.h"

#include <gtest/gtest.h>

#include <memory>

#include "support/scene_builder.h"

namespace lumel {
namespace {

// `count` separate leaves of 2 cm, in a column above (10, 0, 0), each turned another way.
void add_leaves(Mesh& mesh, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const float s = 0.02f, h = 0.05f * static_cast<float>(i);
        const bool flat = i % 2 == 0;
        test::add_quad(mesh, {10, h, 0}, {s, 0, 0}, flat ? Vec3{0, 0, -s} : Vec3{0, s, 0});
    }
}

struct Garden {
    explicit Garden(std::uint32_t leaves, float trunk = 0.0f) {
        test::SceneBuilder b;
        const auto white = b.material({0.8f, 0.8f, 0.8f});
        b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 0}, {10, 0, 0}, {0, 0, -10}); });
        b.object("bush", white, [&](Mesh& m) {
            add_leaves(m, leaves);
            if (trunk > 0.0f) test::add_quad(m, {9, 0, 0}, {trunk, 0, 0}, {0, trunk, 0});
        });
        scene = b.build();
    }
    ChartSet charts(const ChartOptions& options) {
        Context fresh(1);
        auto geometry = flatten(scene, fresh);
        EXPECT_TRUE(geometry.ok());
        auto made = make_charts(scene, *geometry, options, fresh);
        EXPECT_TRUE(made.ok());
        auto packed = make_atlas(scene, *geometry, *made, options, fresh);
        EXPECT_TRUE(packed.ok());
        atlas = std::move(*packed);
        diagnostics = fresh.diagnostics;
        return std::move(*made);
    }
    [[nodiscard]] bool bush_has_texels() const { return atlas.first_placement[1] != atlas.first_placement[2]; }

    Scene scene;
    Atlas atlas;
    Diagnostics diagnostics;
};

ChartOptions dense(double texels_per_metre) {
    ChartOptions options;
    options.texels_per_metre = texels_per_metre;
    return options;
}

// At 4 texels per metre a leaf of 4 cm2 is worth 0.0064 texels.
TEST(BadCharts, LeavesBecomeVolume) {
    Garden garden(300);
    const ChartSet charts = garden.charts(dense(4));
    EXPECT_EQ(charts.class_of(garden.scene, 0), NodeClass::lightmap);
    EXPECT_EQ(charts.class_of(garden.scene, 1), NodeClass::volume);
    EXPECT_FALSE(charts.gets_texels(garden.scene, 1));
    EXPECT_FALSE(garden.bush_has_texels());
    EXPECT_EQ(garden.atlas.placements.size(), 1u) << "the floor's";
    ASSERT_EQ(garden.diagnostics.count("bad-charts"), 1u);
    EXPECT_EQ(garden.diagnostics.all().back().examples[0],
              "node 'bush' (mesh 'bush'): 300 charts worth 0.006 texels each, 100 % of the surface in the smallest");
}

TEST(BadCharts, WhoAsksForTexelsGetsThem) {
    Garden garden(300);
    garden.scene.instances[1].class_is_asked = true;
    const ChartSet charts = garden.charts(dense(4));
    EXPECT_TRUE(charts.gets_texels(garden.scene, 1));
    EXPECT_TRUE(garden.bush_has_texels());
    EXPECT_EQ(garden.diagnostics.count("bad-charts"), 0u);
}

TEST(BadCharts, EachPartOfTheRuleCounts) {
    const auto demoted = [](Garden garden, double density) {
        return !garden.charts(dense(density)).gets_texels(garden.scene, 1);
    };
    EXPECT_TRUE(demoted(Garden(256), 4));
    EXPECT_FALSE(demoted(Garden(255), 4)) << "too few to matter";
    // (0.02 m)^2 is 1/16 texel at 12.5 texels per metre.
    EXPECT_TRUE(demoted(Garden(256), 12.4));
    EXPECT_FALSE(demoted(Garden(256), 12.6)) << "worth more than a sixteenth";
    // 0.49 m2 of trunk are 7.8 texels beside 1.9 of leaves: 0.03 per chart, but most of the surface is the trunk.
    EXPECT_FALSE(demoted(Garden(300, 0.7f), 4)) << "has a body";
}

// 100 m2 of floor share 1600 texels, be they a budget or a page: 4 per metre, however many charts the leaves are.
TEST(BadCharts, TheDensityIsThatOfTheBareSurface) {
    ChartOptions budget, page;
    budget.texel_budget = 1600;
    page.resolution_width = page.resolution_height = 40;
    for (const ChartOptions& options : {budget, page}) {
        Garden garden(300);
        ChartOptions asked = dense(4);
        const ChartSet charts = garden.charts(asked);
        ChartSet all = charts;
        all.demoted.clear();
        const auto by_density = chart_worths(garden.scene, all, asked),
                   by_texels = chart_worths(garden.scene, all, options);
        ASSERT_EQ(by_density.size(), 2u);
        EXPECT_NEAR(by_texels[1].texels_per_chart(), by_density[1].texels_per_chart(), 0.002 * 0.0064)
            << "0.12 m2 of leaves beside the floor";
        EXPECT_EQ(by_texels[1].charts, 300u);
        EXPECT_DOUBLE_EQ(by_texels[1].smallest, 1.0);
    }
}

// A layout that the artist made is kept, however small its charts are.
TEST(BadCharts, KeptLayoutsAreNotJudged) {
    Garden garden(300);
    auto bush = std::make_shared<Mesh>(*garden.scene.meshes[1]);
    for (std::size_t v = 0; v < bush->positions.size(); ++v) {
        const auto leaf = static_cast<float>(v / 4);
        bush->uv1.push_back({(leaf + 0.8f * bush->uv0[v].x) / 300.0f, 0.8f * bush->uv0[v].y});
    }
    garden.scene.meshes[1] = bush;
    garden.scene.display.meshes[1] = bush;
    const ChartSet charts = garden.charts(dense(4));
    EXPECT_TRUE(charts.meshes[1].from_uv1);
    EXPECT_TRUE(charts.gets_texels(garden.scene, 1));
}

}  // namespace
}  // namespace lumel
