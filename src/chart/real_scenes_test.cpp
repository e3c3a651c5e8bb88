// Charts and atlas of real scenes, judged by the independent checker.
#include <gtest/gtest.h>

#include "chart/chart_set.h"
#include "io/gltf_document.h"
#include "support/chart_layouts.h"
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

class RealScenes : public testing::TestWithParam<RealScene> {};

TEST_P(RealScenes, AreClean) {
    const auto path = test::data_file(std::string("scenes/") + GetParam().file);
    if (!path) GTEST_SKIP() << "no " << GetParam().file << ": set LUMEL_DATA";
    Context context(2);
    auto loaded = load_scene(*path, context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    Level level{std::move(loaded->scene), {}};
    for (Instance& i : level.scene.instances)
        if (i.node_class == NodeClass::probe) i.node_class = NodeClass::lightmap;  // charts for all there is
    auto geometry = flatten(level.scene, context);
    ASSERT_TRUE(geometry.ok()) << geometry.error().text();
    level.geometry = std::move(*geometry);
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
