// Charts and atlas together, judged by the independent checker.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/hash.h"
#include "chart/chart_picture.h"
#include "chart/chart_set.h"
#include "chart/density.h"
#include "chart/lift.h"
#include "io/gltf_document.h"
#include "support/chart_checker.h"
#include "support/meshes.h"
#include "support/test_data.h"

namespace lumel {
namespace {

struct Level {
    Scene scene;
    WorldGeometry geometry;
};

Affine scaled(Vec3 s, Vec3 translation) { return {{Vec3{s.x, 0, 0}, Vec3{0, s.y, 0}, Vec3{0, 0, s.z}}, translation}; }

class LevelBuilder {
public:
    std::uint32_t mesh(Mesh m) {
        scene_.meshes.push_back(std::make_shared<const Mesh>(std::move(m)));
        return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
    }
    LevelBuilder& instance(std::uint32_t mesh, const Affine& transform = {}, NodeClass c = NodeClass::lightmap) {
        scene_.instances.push_back({"node " + std::to_string(scene_.instances.size()), mesh, transform, c, 1.0f});
        return *this;
    }
    Level build() {
        scene_.materials.emplace_back();
        scene_.display.meshes = scene_.meshes;
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i)
            scene_.display.instances.push_back({{}, scene_.instances[i].mesh, i});
        Context context(1);
        auto geometry = flatten(scene_, context);
        EXPECT_TRUE(geometry.ok());
        return {std::move(scene_), std::move(*geometry)};
    }

private:
    Scene scene_;
};

struct Layout {
    ChartSet charts;
    Atlas atlas;
};

Layout layout(const Level& level, const ChartOptions& options, Context& context) {
    auto charts = make_charts(level.scene, level.geometry, options, context);
    EXPECT_TRUE(charts.ok()) << (charts.ok() ? "" : charts.error().text());
    if (!charts.ok()) return {};
    auto atlas = make_atlas(level.scene, level.geometry, *charts, options, context);
    EXPECT_TRUE(atlas.ok()) << (atlas.ok() ? "" : atlas.error().text());
    if (!atlas.ok()) return {};
    return {std::move(*charts), std::move(*atlas)};
}

test::LayoutReport judge(const Level& level, const Layout& l) {
    return test::ChartChecker(level.scene, level.geometry, l.charts, l.atlas).run();
}

void expect_clean(const test::LayoutReport& report) {
    EXPECT_GT(report.texels, 0u);
    EXPECT_GT(report.samples, 0u);
    EXPECT_EQ(report.shared_texels, 0u);
    EXPECT_EQ(report.outside, 0u);
    EXPECT_EQ(report.unmapped, 0u);
    EXPECT_EQ(report.flipped, 0u);
    EXPECT_EQ(report.overlaps, 0u);
}

const Diagnostic* diagnostic(const Context& context, std::string_view code) {
    for (const Diagnostic& d : context.diagnostics.all())
        if (d.code == code) return &d;
    return nullptr;
}
std::string first_example(const Context& context, std::string_view code) {
    const Diagnostic* d = diagnostic(context, code);
    return d && !d->examples.empty() ? d->examples[0] : "";
}
std::string message(const Context& context, std::string_view code) {
    const Diagnostic* d = diagnostic(context, code);
    return d ? d->message : "";
}

// Boxes, tubes and spheres at many places and scales, one mirrored, one stretched, one that gets no texels.
Level mixed_level() {
    LevelBuilder b;
    const std::uint32_t box = b.mesh(test::box({1, 2, 3})), ball = b.mesh(test::sphere(12, 0.7f)),
                        tube = b.mesh(test::cylinder(20, 1.0f, 0.5f, 3.0f)), floor = b.mesh(test::flat_grid(8, 10.0f));
    for (int i = 0; i < 12; ++i) {
        const float x = 4.0f * static_cast<float>(i);
        const float s = i % 3 == 0 ? 1.0f : 0.4f + 0.1f * static_cast<float>(i);
        b.instance(box, scaled({s, s, i == 5 ? -s : s}, {x, 0, 0}));
        b.instance(ball, scaled({s, s, s}, {x, 5, 0}));
        b.instance(tube, scaled({s, s, s}, {x, 10, 0}));
    }
    b.instance(box, scaled({20, 0.1f, 3}, {0, 0, 9}));
    b.instance(ball, scaled({1, 1, 1}, {0, 0, 20}), NodeClass::volume);
    b.instance(floor);
    return b.build();
}

TEST(Atlas, AMixedLevelIsClean) {
    const Level level = mixed_level();
    Context context(2);
    ChartOptions options;
    options.texel_budget = 60000;
    const Layout l = layout(level, options, context);
    const test::LayoutReport report = judge(level, l);
    expect_clean(report);
    EXPECT_EQ(l.atlas.pages.size(), 1u);
    EXPECT_NEAR(static_cast<double>(report.texels), 60000.0, 0.02 * 60000) << "whole texels: a step of many instances";
    EXPECT_GT(static_cast<double>(report.texels) / static_cast<double>(report.page_texels), 0.85);
    EXPECT_LT(report.stretch, 1.05);
    const std::size_t volume = level.scene.instances.size() - 2;
    EXPECT_EQ(l.atlas.first_placement[volume], l.atlas.first_placement[volume + 1]) << "no texels for a volume node";
}

TEST(Atlas, SmallPagesKeepInstancesWhole) {
    const Level level = mixed_level();
    Context context(1);
    ChartOptions options;
    options.texel_budget = 60000;
    options.max_page = 128;
    const Layout l = layout(level, options, context);
    expect_clean(judge(level, l));
    EXPECT_GE(l.atlas.pages.size(), 4u);
    for (std::uint32_t i = 0; i < level.scene.instances.size(); ++i) {
        // The floor and the long box may be larger than a page; all others are small.
        if (i + 3 >= level.scene.instances.size()) continue;
        for (std::uint32_t p = l.atlas.first_placement[i]; p < l.atlas.first_placement[i + 1]; ++p)
            EXPECT_EQ(l.atlas.placements[p].page, l.atlas.placements[l.atlas.first_placement[i]].page) << i;
    }
}

// World metres over texels, along both axes of every triangle of instance `i`: mean over its triangles.
double texels_per_metre(const Level& level, const Layout& l, std::uint32_t i) {
    double texels = 0.0, metres = 0.0;
    for (std::uint32_t w = level.geometry.first_triangle[i]; w < level.geometry.first_triangle[i + 1]; ++w) {
        const auto uv = l.atlas.triangle_uv(l.charts, level.geometry, level.scene, w);
        texels += 0.5 * std::abs(cross(uv.texels[1] - uv.texels[0], uv.texels[2] - uv.texels[0]));
        metres += level.geometry.area(w);
    }
    return std::sqrt(texels / metres);
}

TEST(Atlas, DensityIsThatOfTheWorld) {
    LevelBuilder b;
    const std::uint32_t floor = b.mesh(test::flat_grid(4, 1.0f));
    b.instance(floor).instance(floor, scaled({10, 10, 10}, {20, 0, 0})).instance(floor, scaled({30, 1, 2}, {0, 0, 90}));
    Level level = b.build();
    level.scene.instances[0].density_scale = 3.0f;
    Context context(1);
    ChartOptions options;
    options.texels_per_metre = 20.0;
    const Layout l = layout(level, options, context);
    EXPECT_EQ(l.atlas.texels_per_metre, 20.0);
    EXPECT_NEAR(texels_per_metre(level, l, 0), 60.0, 1e-3);
    EXPECT_NEAR(texels_per_metre(level, l, 1), 20.0, 1e-3);
    EXPECT_NEAR(texels_per_metre(level, l, 2), 20.0, 1e-3);
    // The stretched floor is 600 x 40 texels, not a square of the same area.
    const ChartPlacement& p = l.atlas.placements[l.atlas.first_placement[2]];
    EXPECT_NEAR(std::max(p.scale.x, p.scale.y), 600.0, 1e-2);
    EXPECT_NEAR(std::min(p.scale.x, p.scale.y), 40.0, 1e-3);
}

TEST(Atlas, ChartBoxesEndOnTexelCentres) {
    const Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    std::size_t checked = 0;
    for (std::uint32_t i = 0; i < level.scene.instances.size(); ++i)
        for (std::uint32_t p = l.atlas.first_placement[i]; p < l.atlas.first_placement[i + 1]; ++p) {
            const Chart& chart = l.charts.meshes[level.scene.instances[i].mesh].charts[p - l.atlas.first_placement[i]];
            for (const Vec2 corner : {chart.min, chart.max}) {
                const Vec2 t = corner * l.atlas.placements[p].scale + l.atlas.placements[p].offset;
                // A few roundings of floats up to the page's edge.
                EXPECT_NEAR(t.x - std::floor(t.x), 0.5, 2e-4);
                EXPECT_NEAR(t.y - std::floor(t.y), 0.5, 2e-4);
                ++checked;
            }
            const Vec2 size = (chart.max - chart.min) * l.atlas.placements[p].scale;
            EXPECT_GT(std::min(size.x, size.y), 0.99f) << "2 x 2 texels at least";
        }
    EXPECT_GT(checked, 100u);
}

TEST(Atlas, OneResolutionForAll) {
    const Level level = mixed_level();
    Context context(1);
    ChartOptions options;
    options.resolution_width = 256;
    options.resolution_height = 128;
    const Layout l = layout(level, options, context);
    const test::LayoutReport report = judge(level, l);
    expect_clean(report);
    ASSERT_EQ(l.atlas.pages.size(), 1u);
    EXPECT_EQ(l.atlas.pages[0].width, 256u);
    EXPECT_EQ(l.atlas.pages[0].height, 128u);
    EXPECT_GT(report.texels, 256u * 128u * 8 / 10);
}

TEST(Atlas, WhatDoesNotFitIsAnError) {
    const Level level = mixed_level();
    Context context(1);
    ChartOptions options;
    options.resolution_width = options.resolution_height = 16;
    const auto charts = make_charts(level.scene, level.geometry, options, context);
    ASSERT_TRUE(charts.ok());
    const auto tiny = make_atlas(level.scene, level.geometry, *charts, options, context);
    ASSERT_FALSE(tiny.ok());
    EXPECT_EQ(tiny.error().code, ErrorCode::usage);
    options.resolution_width = options.resolution_height = 256;
    options.texels_per_metre = 1000.0;
    const auto dense = make_atlas(level.scene, level.geometry, *charts, options, context);
    ASSERT_FALSE(dense.ok());
    EXPECT_NE(dense.error().text().find("--texels-per-metre"), std::string::npos);
}

// A wall of 100 m and one of 10 m, both 1 m high, at 8 texels a metre on pages of 128: the long one gets 127 steps of
// the 800 that were asked for, along its length alone.
TEST(Atlas, DensityIsWhatWasReached) {
    LevelBuilder builder;
    for (const float length : {100.0f, 10.0f}) {
        const auto point = [length](float u, float v) { return Vec3{length * u, v, 0}; };
        builder.instance(builder.mesh(test::surface(1, 1, point)));
    }
    const Level level = builder.build();
    ChartOptions options;
    options.texels_per_metre = 8.0;
    for (const std::uint32_t max_page : {128u, 1024u}) {
        options.max_page = max_page;
        Context context(1);
        const Layout l = layout(level, options, context);
        if (max_page == 1024) {
            EXPECT_EQ(l.atlas.texels_per_metre, 8.0);
            EXPECT_EQ(l.atlas.least_texels_per_metre, 8.0);
            EXPECT_TRUE(context.diagnostics.all().empty());
            continue;
        }
        EXPECT_NEAR(l.atlas.least_texels_per_metre, 8.0 * std::sqrt(127.0 / 800.0), 1e-6);
        EXPECT_NEAR(l.atlas.texels_per_metre, 8.0 * std::sqrt((100.0 * 127.0 / 800.0 + 10.0) / 110.0), 1e-6);
        EXPECT_EQ(context.diagnostics.count("chart-clamped"), 1u);
        EXPECT_EQ(context.diagnostics.all()[0].examples, std::vector<std::string>{"node 0"});
        EXPECT_NE(context.diagnostics.all()[0].message.find("fewer than 8 texels"), std::string::npos);
    }
}

TEST(Atlas, CancelledIsCancelled) {
    const Level level = mixed_level();
    Context context(1);
    context.request_cancel();
    const auto charts = make_charts(level.scene, level.geometry, {}, context);
    ASSERT_FALSE(charts.ok());
    EXPECT_EQ(charts.error().code, ErrorCode::cancelled);
}

Hash128 hash_of(const Layout& l) {
    Hasher hasher;
    for (const MeshCharts& m : l.charts.meshes) {
        hasher.array(std::span(m.chart_of_triangle)).array(std::span(m.order));
        for (const auto& t : m.uv)
            for (const Vec2 p : t) hasher.pod(p.x).pod(p.y);
    }
    for (const ChartPlacement& p : l.atlas.placements)
        hasher.pod(p.page).pod(p.scale.x).pod(p.scale.y).pod(p.offset.x).pod(p.offset.y);
    for (const AtlasPage& p : l.atlas.pages) hasher.pod(p.width).pod(p.height);
    return hasher.finish();
}

TEST(Atlas, SameBitsForAnyNumberOfThreads) {
    const Level level = mixed_level();
    std::vector<Hash128> hashes;
    for (const unsigned threads : {1u, 2u, 8u}) {
        Context context(threads);
        hashes.push_back(hash_of(layout(level, {}, context)));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Atlas, NoLightmapInstancesNoPages) {
    LevelBuilder b;
    b.instance(b.mesh(test::box({1, 1, 1})), {}, NodeClass::volume);
    const Level level = b.build();
    Context context(1);
    const Layout l = layout(level, {}, context);
    EXPECT_TRUE(l.atlas.pages.empty());
    EXPECT_EQ(l.atlas.triangle_uv(l.charts, level.geometry, level.scene, 0).page, kNone);
}

// A mesh without any area at all beside a proper one.
TEST(Atlas, MeshesWithoutAreaGetNothing) {
    LevelBuilder b;
    Mesh line;
    line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.normals.assign(3, {0, 1, 0});
    line.triangles = {{0, 1, 2}};
    test::cover_with_one_primitive(line);
    b.instance(b.mesh(std::move(line))).instance(b.mesh(test::box({1, 1, 1})));
    const Level level = b.build();
    Context context(1);
    const Layout l = layout(level, {}, context);
    expect_clean(judge(level, l));
    EXPECT_EQ(l.atlas.triangle_uv(l.charts, level.geometry, level.scene, 0).page, kNone);
}

// ---- TEXCOORD_1 -----------------------------------------------------------------------------------------------------

Mesh floor_with_uv1(Vec2 low, Vec2 size) {
    Mesh mesh = test::flat_grid(2, 2.0f);
    for (const Vec3 p : mesh.positions) mesh.uv1.push_back(low + Vec2{0.5f * p.x, -0.5f * p.z} * size);
    return mesh;
}

TEST(KeptLayout, IsKeptUnchanged) {
    LevelBuilder b;
    b.instance(b.mesh(floor_with_uv1({0.05f, 0.05f}, {0.4f, 0.4f})));
    b.instance(b.mesh(floor_with_uv1({0.55f, 0.05f}, {0.4f, 0.4f})));
    const Level level = b.build();
    Context context(1);
    ChartOptions options;
    options.resolution_width = 300;
    options.resolution_height = 200;
    const Layout l = layout(level, options, context);
    EXPECT_TRUE(l.charts.scene_wide);
    ASSERT_EQ(l.atlas.pages.size(), 1u);
    EXPECT_EQ(l.atlas.pages[0].width, 300u);
    for (std::uint32_t w = 0; w < level.geometry.triangle_count(); ++w) {
        const auto uv = l.atlas.triangle_uv(l.charts, level.geometry, level.scene, w);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 file = level.geometry.uv1[level.geometry.triangles[w].vertices[k]];
            EXPECT_EQ(uv.texels[k], (Vec2{file.x * 300.0f, file.y * 200.0f}));
        }
    }
    expect_clean(judge(level, l));
    EXPECT_TRUE(context.diagnostics.all().empty());
}

// Two floors of 4 m2 on 0.16 of the page each: at 10 texels per metre 800 texels over 0.32 of the page, an edge of 50.
TEST(KeptLayout, ResolutionFollowsDensityOrBudget) {
    LevelBuilder b;
    b.instance(b.mesh(floor_with_uv1({0.05f, 0.05f}, {0.4f, 0.4f})));
    b.instance(b.mesh(floor_with_uv1({0.55f, 0.05f}, {0.4f, 0.4f})));
    const Level level = b.build();
    Context context(1);
    ChartOptions options;
    options.texels_per_metre = 10.0;
    EXPECT_EQ(layout(level, options, context).atlas.pages[0].width, 52u) << "50, up to a multiple of 4";
    options.texels_per_metre = 0.0;
    options.texel_budget = 3200.0;
    EXPECT_EQ(layout(level, options, context).atlas.pages[0].width, 100u);
}

TEST(KeptLayout, NodesThatOverlapGetChartsPerMesh) {
    LevelBuilder b;
    b.instance(b.mesh(floor_with_uv1({0, 0}, {0.5f, 0.5f})))
        .instance(b.mesh(floor_with_uv1({0.2f, 0.2f}, {0.8f, 0.8f})));
    const Level level = b.build();
    Context context(1);
    const Layout l = layout(level, {}, context);
    EXPECT_FALSE(l.charts.scene_wide);
    EXPECT_TRUE(l.charts.meshes[0].from_uv1);
    expect_clean(judge(level, l));
    // Kept mesh by mesh, but not unchanged: that is told, and why.
    EXPECT_GT(context.diagnostics.count("uv1-repacked"), 0u);
    EXPECT_NE(first_example(context, "uv1-repacked").find("node 'node 0' triangle "), std::string::npos);
    EXPECT_NE(first_example(context, "uv1-repacked").find(" and node 'node 1' triangle "), std::string::npos);
    EXPECT_EQ(context.diagnostics.count("uv-overlap"), 0u) << "the mesh layouts themselves are sound";

    ChartOptions asked;
    asked.uv1 = Uv1Policy::scene;
    Context forced(1);
    EXPECT_TRUE(layout(level, asked, forced).charts.scene_wide);
    EXPECT_GT(forced.diagnostics.count("uv-overlap"), 0u);
    EXPECT_EQ(forced.diagnostics.count("uv-overlap"), context.diagnostics.count("uv1-repacked"));
    EXPECT_NE(message(forced, "uv-overlap").find("kept as asked"), std::string::npos);
    EXPECT_GT(forced.diagnostics.count("uv-bleeding"), 0u);
}

TEST(KeptLayout, AMeshInstancedTwiceGetsChartsPerInstance) {
    LevelBuilder b;
    const std::uint32_t m = b.mesh(floor_with_uv1({0, 0}, {0.5f, 0.5f}));
    b.instance(m).instance(m, scaled({1, 1, 1}, {9, 0, 0}));
    const Level level = b.build();
    Context context(1);
    const Layout l = layout(level, {}, context);
    EXPECT_FALSE(l.charts.scene_wide);
    expect_clean(judge(level, l));
    EXPECT_EQ(first_example(context, "uv1-repacked"), "node 'node 1' shares its mesh with another node");
}

TEST(KeptLayout, PaddingTooNarrowForThePageIsReported) {
    LevelBuilder b;
    b.instance(b.mesh(floor_with_uv1({0.0f, 0.0f}, {0.495f, 1})))
        .instance(b.mesh(floor_with_uv1({0.505f, 0}, {0.495f, 1})));
    const Level level = b.build();
    ChartOptions options;
    options.resolution_width = options.resolution_height = 512;
    Context fine(1), coarse(1);
    layout(level, options, fine);
    EXPECT_EQ(fine.diagnostics.count("uv-bleeding"), 0u);
    options.resolution_width = options.resolution_height = 32;
    layout(level, options, coarse);
    EXPECT_EQ(coarse.diagnostics.count("uv-bleeding"), 64u) << "the two columns beside the gap";
    EXPECT_EQ(first_example(coarse, "uv-bleeding"),
              "node 'node 0' chart 0 triangle 2 and node 'node 1' chart 0 triangle 0: 64 texels of 32x32 at UV "
              "(0.4844, 0.0156)");
}

// Both halves of a layout as one mesh, the second one elsewhere in space.
Mesh joined(Mesh two, const Mesh& other, Vec3 shift) {
    const auto first = static_cast<std::uint32_t>(two.positions.size());
    for (std::size_t v = 0; v < other.positions.size(); ++v) {
        two.positions.push_back(other.positions[v] + shift);
        two.normals.push_back(other.normals[v]);
        two.uv1.push_back(other.uv1[v]);
    }
    for (const Triangle& t : other.triangles) two.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    test::cover_with_one_primitive(two);
    return two;
}

ChartOptions square_page(std::uint32_t edge, Uv1Policy policy = Uv1Policy::automatic) {
    ChartOptions options;
    options.resolution_width = options.resolution_height = edge;
    options.uv1 = policy;
    return options;
}

// Within one mesh, islands that share texels are one chart, as a texel has one owner; and that is told.
TEST(KeptLayout, IslandsThatShareTexelsAreOneChart) {
    LevelBuilder b;
    b.instance(
        b.mesh(joined(floor_with_uv1({0, 0}, {0.495f, 1}), floor_with_uv1({0.505f, 0}, {0.495f, 1}), {9, 0, 0})));
    const Level level = b.build();
    Context fine(1), coarse(1), repacked(1);
    EXPECT_EQ(layout(level, square_page(512), fine).charts.meshes[0].charts.size(), 2u);
    EXPECT_EQ(fine.diagnostics.count("uv-bleeding"), 0u);
    const Layout kept = layout(level, square_page(32), coarse);
    EXPECT_TRUE(kept.charts.scene_wide) << "kept unchanged all the same";
    EXPECT_EQ(kept.charts.meshes[0].charts.size(), 1u);
    EXPECT_EQ(coarse.diagnostics.count("uv-bleeding"), 64u) << "the two columns beside the gap";
    // Packed anew they are apart at any resolution.
    const Layout packed = layout(level, square_page(32, Uv1Policy::mesh), repacked);
    EXPECT_EQ(packed.charts.meshes[0].charts.size(), 2u);
    expect_clean(judge(level, packed));
    EXPECT_TRUE(repacked.diagnostics.all().empty());
}

// Tiles of one floor, side by side in space as in the layout, without any padding: their light goes on, nothing bleeds.
TEST(KeptLayout, ChartsThatGoOnInEachOtherDoNotBleed) {
    const Mesh left = floor_with_uv1({0, 0}, {0.5f, 1}), right = floor_with_uv1({0.5f, 0}, {0.5f, 1});
    for (const float gap : {0.0f, 0.5f}) {  // metres; a texel is 2/16 m
        for (const bool one_mesh : {true, false}) {
            LevelBuilder b;
            if (one_mesh)
                b.instance(b.mesh(joined(left, right, {2 + gap, 0, 0})));
            else
                b.instance(b.mesh(left)).instance(b.mesh(right), scaled({1, 1, 1}, {2 + gap, 0, 0}));
            const Level level = b.build();
            Context context(1);
            EXPECT_TRUE(layout(level, square_page(32), context).charts.scene_wide);
            EXPECT_EQ(context.diagnostics.count("uv-bleeding") > 0, gap > 0.0f) << gap << one_mesh;
        }
    }
    // And a wall that stands on the floor's edge: one place, but another light.
    LevelBuilder b;
    const Affine upright{{Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}}, {2, 0, 0}};
    b.instance(b.mesh(left)).instance(b.mesh(right), upright);
    const Level level = b.build();
    Context context(1);
    layout(level, square_page(32), context);
    EXPECT_EQ(context.diagnostics.count("uv-bleeding"), 64u);
}

// A sliver of the surface may have no area in the layout: it lies on a line of another chart, and bleeds nothing.
TEST(KeptLayout, CollapsedTrianglesDoNotBleed) {
    Mesh sliver = test::flat_grid(1, 0.04f);  // 0.04 % of the floor: fewer than the thousandth that is let pass
    for (const Vec3 p : sliver.positions) sliver.uv1.push_back({0.2f + 2.5f * p.x, 0.5f});
    LevelBuilder b;
    b.instance(b.mesh(joined(floor_with_uv1({0, 0}, {1, 1}), sliver, {0.4f, 0, -1})));
    const Level level = b.build();
    Context context(1);
    const Layout l = layout(level, square_page(32), context);
    EXPECT_TRUE(l.charts.scene_wide);
    EXPECT_EQ(l.charts.meshes[0].charts.size(), 2u);
    EXPECT_EQ(context.diagnostics.count("uv-bleeding"), 0u);
}

// Two islands of one mesh on top of each other, under each policy.
TEST(KeptLayout, OverlapsInsideAMesh) {
    LevelBuilder b;
    b.instance(
        b.mesh(joined(floor_with_uv1({0, 0}, {0.5f, 0.5f}), floor_with_uv1({0.25f, 0.25f}, {0.5f, 0.5f}), {9, 0, 0})));
    const Level level = b.build();
    {
        Context context(1);  // automatic: charts of ours
        const Layout l = layout(level, {}, context);
        EXPECT_FALSE(l.charts.meshes[0].from_uv1);
        expect_clean(judge(level, l));
        EXPECT_EQ(context.diagnostics.count("uv1-rejected"), 1u);
        // The quarter of the page that both cover is one cell of 2 x 2 in either: two triangles each, along one
        // diagonal.
        EXPECT_EQ(first_example(context, "uv1-rejected"), "node 'node 0': 2 pairs of triangles overlap in it");
        ASSERT_EQ(context.diagnostics.count("uv-overlap"), 2u);
        EXPECT_EQ(first_example(context, "uv-overlap"), "node 'node 0' triangles 6 and 8 at UV (0.4167, 0.3333)");
        EXPECT_NE(message(context, "uv-overlap").find("charts were made"), std::string::npos);
        EXPECT_EQ(context.diagnostics.count("uv1-repacked"), 0u) << "nothing of it was kept";
    }
    {
        Context context(1);  // scene: as it is, and told
        const Layout l = layout(level, square_page(64, Uv1Policy::scene), context);
        EXPECT_TRUE(l.charts.scene_wide);
        EXPECT_EQ(context.diagnostics.count("uv-overlap"), 2u);
        EXPECT_NE(message(context, "uv-overlap").find("kept as asked"), std::string::npos);
    }
    {
        Context context(1);  // mesh: islands on top of each other are packed apart
        const Layout l = layout(level, square_page(64, Uv1Policy::mesh), context);
        EXPECT_TRUE(l.charts.meshes[0].from_uv1);
        EXPECT_EQ(l.charts.meshes[0].charts.size(), 2u);
        expect_clean(judge(level, l));
        EXPECT_EQ(context.diagnostics.count("uv-overlap"), 2u);
        EXPECT_NE(message(context, "uv-overlap").find("packed apart"), std::string::npos);
    }
}

TEST(KeptLayout, UvsThatAreNoNumbersAreRejected) {
    LevelBuilder b;
    Mesh bad = floor_with_uv1({0, 0}, {1, 1});
    bad.uv1[4].x = std::nanf("");
    b.instance(b.mesh(std::move(bad)));
    const Level level = b.build();
    for (const Uv1Policy policy : {Uv1Policy::automatic, Uv1Policy::mesh}) {
        Context context(1);
        ChartOptions options;
        options.uv1 = policy;
        const Layout l = layout(level, options, context);
        EXPECT_FALSE(l.charts.meshes[0].from_uv1);
        expect_clean(judge(level, l));
        EXPECT_NE(first_example(context, "uv1-rejected").find("not finite at triangle"), std::string::npos);
    }
    Context context(1);
    EXPECT_FALSE(make_charts(level.scene, level.geometry, square_page(64, Uv1Policy::scene), context).ok());
}

TEST(KeptLayout, RejectedLayoutsGetChartsOfOurs) {
    LevelBuilder b;
    Mesh bad = floor_with_uv1({0, 0}, {1.5f, 1});
    b.instance(b.mesh(std::move(bad))).instance(b.mesh(test::box({1, 1, 1})));
    const Level level = b.build();
    Context context(1);
    const Layout l = layout(level, {}, context);
    EXPECT_FALSE(l.charts.meshes[0].from_uv1);
    EXPECT_EQ(context.diagnostics.count("uv1-rejected"), 1u) << "the box has none, which is no fault";
    expect_clean(judge(level, l));

    ChartOptions options;
    options.uv1 = Uv1Policy::scene;
    const auto refused = make_charts(level.scene, level.geometry, options, context);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
}

// ---- Helpers of the interface ---------------------------------------------------------------------------------------

TEST(Lift, IsTheIdentityCornerByCorner) {
    const Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    for (std::uint32_t i = 0; i < level.scene.instances.size(); ++i) {
        const auto lifted = lift(level.scene, l.charts, l.atlas, i);
        if (level.scene.instances[i].node_class != NodeClass::lightmap) {
            EXPECT_TRUE(lifted.empty());
            continue;
        }
        const std::uint32_t first = level.geometry.first_triangle[i];
        ASSERT_EQ(lifted.size(), level.geometry.first_triangle[i + 1] - first);
        for (std::uint32_t t = 0; t < lifted.size(); ++t) {
            const auto baked = l.atlas.triangle_uv(l.charts, level.geometry, level.scene, first + t);
            EXPECT_EQ(lifted[t].page, baked.page);
            EXPECT_EQ(lifted[t].texels, baked.texels);
        }
    }
}

TEST(LiftDeathTest, RefusesAnotherMesh) {
    Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    level.scene.display.meshes[0] = std::make_shared<const Mesh>(*level.scene.display.meshes[0]);  // equal is not same
    EXPECT_DEATH(lift(level.scene, l.charts, l.atlas, 0), "displayed mesh");
}

TEST(ChartPicture, OwnersAreThoseOfTheMasks) {
    const Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    const std::vector<std::uint32_t> ids = chart_ids(level.scene, l.charts, l.atlas, 0);
    const auto owned =
        static_cast<std::uint64_t>(std::count_if(ids.begin(), ids.end(), [](std::uint32_t id) { return id != kNone; }));
    // The checker leaves out what rounding may touch, a thousandth of a texel.
    const auto expected = static_cast<double>(judge(level, l).texels);
    EXPECT_NEAR(static_cast<double>(owned), expected, 1e-3 * expected);
    const auto rgb = color_ids(ids);
    for (std::size_t i = 0; i < ids.size(); ++i)
        EXPECT_EQ(ids[i] == kNone, rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2] == 0) << i;
}

// ---- Real scenes ----------------------------------------------------------------------------------------------------

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
    testing::Values(RealScene{"kenney_city.glb", 950, false}, RealScene{"godot_room.glb", 120, false},
                    RealScene{"smooth_sphere_lowpoly.glb", 14, false}, RealScene{"freedoom_e1m1.glb", 1600, false},
                    RealScene{"cornell_box.glb", 19, false}, RealScene{"godot_player.glb", 130, false},
                    RealScene{"bench_courtyard.glb", 60, true}, RealScene{"bench_cornell.glb", 20, true}),
    [](const auto& info) {
        std::string name = info.param.file;
        return name.substr(0, name.find('.'));
    });

}  // namespace
}  // namespace lumel
