// Figures of layouts whose answer is known.
#include "chart/layout_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/chart_layouts.h"

namespace lumel {
namespace {

using test::layout;
using test::Layout;
using test::Level;
using test::LevelBuilder;

// A floor of 10 x 10 m at 8 texels per metre: a box of 81 x 81 texels, the outer ones half.
TEST(LayoutFigures, OfAFloor) {
    LevelBuilder builder;
    builder.instance(builder.mesh(test::flat_grid(8, 10.0f)));
    const Level level = builder.build();
    Context context(1);
    ChartOptions options;
    options.texels_per_metre = 8;
    const Layout l = layout(level, options, context);
    ASSERT_EQ(l.atlas.placements.size(), 1u);
    EXPECT_EQ(l.atlas.placements[0].box, (ChartBox{0, 0, 81, 81}));
    EXPECT_EQ(l.atlas.density, 8.0);
    const TexelOwners owners = texel_owners(level.scene, level.geometry, l.charts, l.atlas, 0);
    const PageFigures page = page_figures(owners);
    EXPECT_EQ(page.used, 81u * 81u);
    EXPECT_EQ(page.covered, 81u * 81u);
    const double page_texels = static_cast<double>(owners.triangle.size());
    EXPECT_DOUBLE_EQ(page.efficiency, 81.0 * 81.0 / page_texels);
    const std::vector<double> densities = triangle_densities(level.scene, level.geometry, l.charts, l.atlas);
    for (const double density : densities) EXPECT_NEAR(density, 8.0, 1e-4);  // coordinates are floats below 81
    EXPECT_NEAR(mean_density(level.geometry, densities), 8.0, 1e-4);
    EXPECT_NEAR(layout_stretch(level.scene, level.geometry, l.charts), 1.0, 1e-6);
    const std::vector<std::vector<double>> stretches = triangle_stretches(level.scene, l.charts);
    ASSERT_EQ(stretches[0].size(), level.geometry.triangle_count());
    for (const double stretch : stretches[0]) EXPECT_NEAR(stretch, 1.0, 1e-6);
}

// A kept TEXCOORD_1 that squeezes a square to (1, 1/2): L2 = sqrt((1 + 4) / 2 * 1/2) = sqrt(5/4) with areas made equal.
TEST(LayoutFigures, KnowASqueezedLayout) {
    Mesh mesh = test::flat_grid(2, 1.0f);
    for (const Vec3& p : mesh.positions) mesh.uv1.push_back({0.5f + 0.5f * p.x, 0.5f + 0.25f * p.z});
    // Counter-clockwise or not, the corners lie within [0, 1].
    for (const Vec2& uv : mesh.uv1) ASSERT_TRUE(uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f);
    LevelBuilder builder;
    builder.instance(builder.mesh(std::move(mesh)));
    const Level level = builder.build();
    Context context(1);
    ChartOptions options;
    options.texels_per_metre = 32;
    const Layout l = layout(level, options, context);
    ASSERT_TRUE(l.charts.scene_wide);
    EXPECT_EQ(l.atlas.placements[0].box, ChartBox{}) << "a kept layout has no boxes";
    EXPECT_NEAR(layout_stretch(level.scene, level.geometry, l.charts), std::sqrt(1.25), 1e-6);
    const std::vector<double> densities = triangle_densities(level.scene, level.geometry, l.charts, l.atlas);
    const AtlasPage page = l.atlas.pages[0];
    const double area = 0.5 * page.width * 0.25 * page.height;  // texels of the square metre
    EXPECT_NEAR(mean_density(level.geometry, densities), std::sqrt(area), 1e-3);
}

// Every texel that a chart owns shows one of its triangles, and what is covered is what the budget counts.
TEST(TexelOwners, AreTrianglesOfTheChartThatOwnsTheTexel) {
    const Level level = test::mixed_level();
    Context context(1);
    ChartOptions options;
    options.texel_budget = 20000;
    const Layout l = layout(level, options, context);
    const std::vector<std::uint32_t> ids = chart_ids(level.scene, l.charts, l.atlas, 0);
    const TexelOwners owners = texel_owners(level.scene, level.geometry, l.charts, l.atlas, 0);
    ASSERT_EQ(ids.size(), owners.triangle.size());
    std::size_t owned = 0, covered = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        ASSERT_EQ(ids[i] == kNone, owners.triangle[i] == kNone) << i;
        if (ids[i] == kNone) continue;
        const WorldTriangle& t = level.geometry.triangles[owners.triangle[i]];
        const MeshCharts& mesh = l.charts.meshes[level.scene.instances[t.instance].mesh];
        ASSERT_EQ(ids[i], l.atlas.first_placement[t.instance] + mesh.chart_of_triangle[t.mesh_triangle]) << i;
        ++owned;
        covered += owners.covered[i];
    }
    const PageFigures page = page_figures(owners);
    EXPECT_EQ(page.used, owned);
    EXPECT_EQ(page.covered, covered);
    EXPECT_LT(covered, owned);
    EXPECT_NEAR(static_cast<double>(covered), options.texel_budget, 0.005 * options.texel_budget);
}

}  // namespace
}  // namespace lumel
