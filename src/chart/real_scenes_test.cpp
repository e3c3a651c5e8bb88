// Charts and atlas of real scenes, judged by the independent checker.
#include <gtest/gtest.h>

#include <optional>

#include "chart/chart_set.h"
#include "io/gltf_document.h"
#include "support/chart_layouts.h"
#include "support/shared_cells.h"
#include "support/test_data.h"

namespace lumel {
namespace {

using test::expect_clean;
using test::judge;
using test::layout;
using test::Layout;
using test::Level;

struct RealScene {
    const char* file;
    std::size_t most_charts;  // a little above what it takes today
    bool scene_wide;
};

std::optional<Level> load_level(const char* file, Context& context) {
    const auto path = test::data_file(std::string("scenes/") + file);
    if (!path) return std::nullopt;
    auto loaded = load_scene(*path, context);
    EXPECT_TRUE(loaded.ok()) << loaded.error().text();
    if (!loaded.ok()) return std::nullopt;
    Level level{std::move(loaded->scene), {}};
    for (Instance& i : level.scene.instances)
        if (i.node_class == NodeClass::probe) i.node_class = NodeClass::lightmap;  // charts for all there is
    auto geometry = flatten(level.scene, context);
    EXPECT_TRUE(geometry.ok()) << geometry.error().text();
    if (!geometry.ok()) return std::nullopt;
    level.geometry = std::move(*geometry);
    return level;
}

class RealScenes : public testing::TestWithParam<RealScene> {};

TEST_P(RealScenes, AreClean) {
    Context context(2);
    const std::optional<Level> loaded = load_level(GetParam().file, context);
    if (!loaded) GTEST_SKIP() << "no " << GetParam().file << ": set LUMEL_DATA";
    const Level& level = *loaded;
    const Layout l = layout(level, {}, context);
    const test::LayoutReport report = judge(level, l);
    EXPECT_EQ(l.charts.scene_wide, GetParam().scene_wide);
    expect_clean(report);
    std::size_t charts = 0;
    for (const MeshCharts& m : l.charts.meshes) charts += m.charts.size();
    EXPECT_LE(charts, GetParam().most_charts);
    EXPECT_LE(report.stretch, 1.05);
    EXPECT_EQ(context.diagnostics.count("unwrap-fallback"), 0u);
}

// The room as its runtime would look it up from afar: brute force over every texel of every mip.
TEST(RealScene, ARoomSharesNoTexelOfFourMips) {
    Context context(2);
    const std::optional<Level> level = load_level("godot_room.glb", context);
    if (!level) GTEST_SKIP() << "no godot_room.glb: set LUMEL_DATA";
    ChartOptions options;
    const MaskRule rule{LookupFilter::bilinear, 4, 1};
    EXPECT_GT(test::shared_cells(*level, layout(*level, options, context), rule), 0u) << "nothing is tested";
    options.masks = rule;
    const Layout l = layout(*level, options, context);
    EXPECT_EQ(test::shared_cells(*level, l, rule), 0u);
    expect_clean(judge(*level, l));
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealScenes,
    testing::Values(RealScene{"kenney_city.glb", 760, false}, RealScene{"godot_room.glb", 46, false},
                    RealScene{"smooth_sphere_lowpoly.glb", 4, false}, RealScene{"freedoom_e1m1.glb", 960, false},
                    RealScene{"cornell_box.glb", 19, false}, RealScene{"godot_player.glb", 74, false},
                    RealScene{"bench_courtyard.glb", 60, true}, RealScene{"bench_cornell.glb", 20, true}),
    [](const auto& info) {
        std::string name = info.param.file;
        return name.substr(0, name.find('.'));
    });

}  // namespace
}  // namespace lumel
