#include "chart/density.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>

#include "chart/mesh_charts.h"
#include "support/meshes.h"

namespace lumel {
namespace {

// One flat chart of 2 x 1 m, instanced with the transforms given.
struct Fixture {
    Scene scene;
    ChartSet charts;

    explicit Fixture(const std::vector<Affine>& transforms) {
        Mesh mesh = test::surface(1, 1, [](float u, float v) { return Vec3{2.0f * u, v, 0}; });
        MeshCharts c;
        c.chart_of_triangle = {0, 0};
        for (const Triangle& t : mesh.triangles) {
            c.uv.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) c.uv.back()[k] = {mesh.positions[t[k]].x, mesh.positions[t[k]].y};
        }
        index_charts(c);
        charts.meshes = {c};
        scene.meshes = {std::make_shared<const Mesh>(std::move(mesh))};
        for (const Affine& t : transforms) scene.instances.push_back({"", 0, t, NodeClass::lightmap, 1.0f});
    }
};

constexpr SizeLimit kNoLimit{16384, 16384};

// Rotation about z by 30 degrees times `s`.
Affine turned(Vec3 s) {
    const float c = 0.8660254f, d = 0.5f;
    return {{Vec3{c, d, 0} * s.x, Vec3{-d, c, 0} * s.y, Vec3{0, 0, 1} * s.z}, {}};
}

TEST(Density, EvenTransformsGiveTheirFactor) {
    const Fixture f({turned({1, 1, 1}), turned({3, 3, 3}), turned({3, 3, -3})});
    const auto instances = chart_instances(f.scene, f.charts);
    ASSERT_EQ(instances.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(instances[i].rate_x, i == 0 ? 1.0 : 3.0, 1e-6);
        EXPECT_EQ(instances[i].rate_x, instances[i].rate_y);
    }
}

// Stretched along the chart's own u: 4 along u, 1 along v. The third axis does not matter to a chart in the plane.
TEST(Density, UnevenTransformsStretchTheChartAlike) {
    const Fixture f({turned({4, 1, 50})});
    const auto instances = chart_instances(f.scene, f.charts);
    EXPECT_NEAR(instances[0].rate_x, 4.0, 1e-6);
    EXPECT_NEAR(instances[0].rate_y, 1.0, 1e-6);
}

TEST(Density, MasksTakeWhatWasSaidBeforeTheyAreDrawn) {
    const Fixture f({turned({1, 1, 1}), turned({3, 3, 3}), turned({1, 1, 1})});
    const auto instances = chart_instances(f.scene, f.charts);
    Context context(1);
    const std::vector<std::array<std::uint32_t, 2>> fixed{{0, 0}, {100, 7}, {0, 0}};
    for (const MaskRule& rule : {MaskRule{}, MaskRule{MaskRule::Filter::bicubic, 2, 4}}) {
        for (const bool given : {false, true}) {
            const SizeLimit limit{16384, 16384, rule};
            const std::span<const std::array<std::uint32_t, 2>> sizes =
                given ? std::span(fixed) : std::span(fixed).first(0);
            const auto sized = size_charts(f.charts, instances, 50.0, limit, context, sizes);
            ASSERT_TRUE(sized);
            EXPECT_EQ(sized->masks.size(), 2u) << "two instances share one";
            std::uint64_t bytes = 0;
            for (const ChartMask& mask : sized->masks) bytes += mask.bits.size() * sizeof(std::uint64_t);
            EXPECT_EQ(mask_bytes(f.charts, instances, 50.0, limit, sizes), bytes);
        }
    }
}

TEST(Density, SealedChartsGetAQuarter) {
    Fixture f({turned({1, 1, 1}), turned({1, 1, 1}), turned({1, 1, 1})});
    f.charts.sealed = {{false}, {true}, {}};
    const auto instances = chart_instances(f.scene, f.charts);
    ASSERT_EQ(instances.size(), 3u);
    EXPECT_NEAR(instances[0].rate_x, 1.0, 1e-6);
    EXPECT_NEAR(instances[1].rate_x, 0.25, 1e-6);
    EXPECT_NEAR(instances[1].rate_y, 0.25, 1e-6);
    EXPECT_NEAR(instances[2].rate_x, 1.0, 1e-6);
}

// 2 x 1 m at 10 texels per metre: 20 x 10 steps, 21 x 11 texels; both instances share the mask.
TEST(Density, SizesInWholeSteps) {
    const Fixture f({turned({1, 1, 1}), turned({1, 1, 1}), turned({2, 2, 2})});
    Context context(1);
    const auto sized = size_charts(f.charts, chart_instances(f.scene, f.charts), 10.0, kNoLimit, context);
    ASSERT_TRUE(sized);
    EXPECT_EQ(sized->masks.size(), 2u);
    EXPECT_EQ(sized->mask_of[0], sized->mask_of[1]);
    EXPECT_EQ(sized->masks[sized->mask_of[0]].width, 21u);
    EXPECT_EQ(sized->masks[sized->mask_of[0]].height, 11u);
    EXPECT_EQ(sized->used, 2u * 21 * 11 + 41 * 21);
}

TEST(Density, NeverLessThanTwoByTwoNorMoreThanTheLimit) {
    const Fixture f({turned({1, 1, 1})});
    Context context(1);
    const auto instances = chart_instances(f.scene, f.charts);
    EXPECT_EQ(size_charts(f.charts, instances, 1e-6, kNoLimit, context)->used, 4u);
    const auto clamped = size_charts(f.charts, instances, 1000.0, {64, 128}, context);
    EXPECT_EQ(clamped->masks[0].width, 64u);
    EXPECT_EQ(clamped->masks[0].height, 128u);
    EXPECT_EQ(clamped->clamped.size(), 1u);
}

TEST(Density, MeetsTheBudget) {
    std::vector<Affine> transforms;
    for (int i = 0; i < 100; ++i) {
        const float s = 0.3f + 0.05f * static_cast<float>(i);
        transforms.push_back(turned({s, s, s}));
    }
    const Fixture f(transforms);
    Context context(1);
    const auto instances = chart_instances(f.scene, f.charts);
    for (const BudgetOf what : {BudgetOf::page, BudgetOf::baked})
        for (const double budget : {2000.0, 50000.0, 1e6}) {
            const auto density = solve_density(f.charts, instances, budget, what, kNoLimit, context);
            ASSERT_TRUE(density.ok());
            const auto sized = size_charts(f.charts, instances, *density, kNoLimit, context);
            const std::uint64_t texels = what == BudgetOf::page ? sized->used : sized->covered;
            // A ceiling, but for what whole texels let no density meet: 200 charts of few texels grow together.
            EXPECT_LE(static_cast<double>(texels), 1.002 * budget);
            EXPECT_GE(static_cast<double>(texels), 0.99 * budget);
        }
}

// A hundred charts need 400 texels; a budget of 10 cannot be met, and comes as near as it can.
TEST(Density, ABudgetBelowTheFloorGivesTheFloor) {
    const Fixture f(std::vector<Affine>(100, turned({1, 1, 1})));
    Context context(1);
    const auto instances = chart_instances(f.scene, f.charts);
    const auto density = solve_density(f.charts, instances, 10.0, BudgetOf::page, kNoLimit, context);
    ASSERT_TRUE(density.ok());
    EXPECT_EQ(size_charts(f.charts, instances, *density, kNoLimit, context)->used, 400u);
    EXPECT_EQ(least_texels(instances, BudgetOf::page, {}), 400.0);
}

// What a rule makes of charts of 2 x 2 texels, by what is drawn of them.
TEST(Density, TheFloorIsThatOfTheRule) {
    const Fixture f(std::vector<Affine>(10, turned({1, 1, 1})));
    Context context(1);
    const auto instances = chart_instances(f.scene, f.charts);
    for (const auto filter : {MaskRule::Filter::bilinear, MaskRule::Filter::bicubic})
        for (const std::uint32_t mips : {0u, 2u})
            for (const std::uint32_t block : {1u, 4u}) {
                const MaskRule rule{filter, mips, block};
                const auto sized = size_charts(f.charts, instances, 1e-6, SizeLimit{4096, 4096, rule}, context);
                ASSERT_TRUE(sized);
                EXPECT_EQ(least_texels(instances, BudgetOf::page, rule), static_cast<double>(sized->used)) << mips;
                EXPECT_EQ(least_texels(instances, BudgetOf::baked, rule), static_cast<double>(sized->covered)) << mips;
            }
}

}  // namespace
}  // namespace lumel
