// Charts and atlas together, judged by the independent checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/stopwatch.h"
#include "chart/chart_set.h"
#include "support/chart_layouts.h"
#include "support/shared_cells.h"

namespace lumel {
namespace {

using test::expect_clean;
using test::judge;
using test::layout;
using test::Layout;
using test::Level;
using test::LevelBuilder;
using test::mixed_level;
using test::scaled;
using test::shared_cells;

TEST(Atlas, AMixedLevelIsClean) {
    const Level level = mixed_level();
    Context context(2);
    ChartOptions options;
    options.texel_budget = 60000;
    const Layout l = layout(level, options, context);
    const test::LayoutReport report = judge(level, l);
    expect_clean(report);
    EXPECT_EQ(l.atlas.pages.size(), 1u);
    // The budget is that of baked texels; the judge counts those that lookups touch beyond them, up to a ring a chart.
    EXPECT_GT(report.texels, 60000u * 0.98);
    EXPECT_LT(report.texels, 60000u * 1.08);
    EXPECT_GT(static_cast<double>(report.texels) / static_cast<double>(report.page_texels), 0.85);
    EXPECT_LT(report.stretch, 1.05);
    const std::size_t volume = level.scene.instances.size() - 2;
    EXPECT_EQ(l.atlas.first_placement[volume], l.atlas.first_placement[volume + 1]) << "no texels for a volume node";
}

TEST(Atlas, ChartsShareNoTexelUnderTheDeclaredFilter) {
    const Level level = mixed_level();
    const auto lay_out = [&](const MaskRule& rule) {
        Context context(2);
        ChartOptions options;
        options.texel_budget = 8000;
        options.masks = rule;
        return layout(level, options, context);
    };
    const Layout plain = lay_out({});
    EXPECT_EQ(shared_cells(level, plain, {}), 0u);
    for (const MaskRule& rule :
         {MaskRule{MaskRule::Filter::bicubic, 0, 1}, MaskRule{MaskRule::Filter::bilinear, 0, 4},
          MaskRule{MaskRule::Filter::bilinear, 2, 1}, MaskRule{MaskRule::Filter::bicubic, 1, 4}}) {
        EXPECT_GT(shared_cells(level, plain, rule), 0u) << "the plain layout would do: nothing is tested";
        const Layout l = lay_out(rule);
        EXPECT_EQ(shared_cells(level, l, rule), 0u);
        for (const AtlasPage& page : l.atlas.pages) EXPECT_EQ(page.width % rule.cell(), 0u);
    }
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

// 400 walls of 4096 x 4096 texels are 800 MiB of masks, and half a minute to draw and pack: it is not begun.
TEST(Atlas, WhatWouldTakeTooMuchMemoryIsNotDrawn) {
    LevelBuilder builder;
    for (int i = 0; i < 400; ++i) {
        const float size = 1.0f + 0.001f * static_cast<float>(i);
        builder.instance(builder.mesh(test::flat_grid(1, size)),
                         scaled({1, 1, 1}, {2.0f * static_cast<float>(i), 0, 0}));
    }
    const Level level = builder.build();
    ChartOptions options;
    options.texels_per_metre = 1e6;
    options.max_mask_bytes = 600 << 20;
    Context context(1);
    const auto charts = make_charts(level.scene, level.geometry, options, context);
    ASSERT_TRUE(charts.ok());
    const Stopwatch clock;
    const auto atlas = make_atlas(level.scene, level.geometry, *charts, options, context);
    ASSERT_FALSE(atlas.ok());
    EXPECT_LT(clock.seconds(), 2.0) << "drawing one of the 400 masks takes some ten milliseconds";
    EXPECT_EQ(atlas.error().code, ErrorCode::out_of_memory);
    EXPECT_EQ(atlas.error().message,
              "the masks of 400 charts at 1e+06 texels per metre take 800 MB, and 600 MB are allowed");
    EXPECT_NE(atlas.error().remedy.find("--texels-per-metre"), std::string::npos);
}

TEST(Atlas, RefusesMasksThatCannotBe) {
    const Level level = mixed_level();
    Context context(1);
    const auto charts = make_charts(level.scene, level.geometry, {}, context);
    ASSERT_TRUE(charts.ok());
    const auto fault = [&](const ChartOptions& options) {
        const auto atlas = make_atlas(level.scene, level.geometry, *charts, options, context);
        if (atlas.ok()) return std::string("none");
        EXPECT_EQ(atlas.error().code, ErrorCode::usage);
        return atlas.error().text();
    };
    ChartOptions options;
    options.masks.mips = 7;
    EXPECT_EQ(fault(options), "charts cannot be kept apart in mip 7 (ask for 6 at most)");
    options.masks.mips = 0;
    options.masks.block = 2;
    EXPECT_EQ(fault(options), "blocks of 2 texels are not known (ask for 1 or 4)");
    options.masks.block = 4;
    options.resolution_width = 256;
    options.resolution_height = 250;
    EXPECT_EQ(fault(options),
              "a page of 256x250 texels is no whole number of cells of 4 (ask for a --resolution of multiples of 4)");
    options.resolution_height = 252;
    EXPECT_EQ(fault(options), "none");
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

// Counted here anew: every texel of every page and mip.
double bytes_of(const Atlas& atlas, double per_texel) {
    double texels = 0.0;
    for (const AtlasPage& page : atlas.pages)
        for (std::uint32_t mip = 0; mip <= atlas.masks.mips; ++mip)
            texels += std::floor(std::ldexp(page.width, -static_cast<int>(mip))) *
                      std::floor(std::ldexp(page.height, -static_cast<int>(mip)));
    return per_texel * texels;
}

TEST(Atlas, TakesTheBytesThatAreAllowed) {
    const Level level = mixed_level();
    for (const std::uint32_t mips : {0u, 2u})
        for (const std::uint32_t max_page : {4096u, 128u})
            for (const double per_texel : {1.0, 8.0}) {
                SCOPED_TRACE(std::to_string(mips) + " mips, pages of " + std::to_string(max_page));
                Context context(1);
                ChartOptions options;
                options.atlas_bytes = static_cast<std::uint64_t>(80000 * per_texel);
                options.bytes_per_texel = per_texel;
                options.max_page = max_page;
                options.masks.mips = mips;
                const Layout l = layout(level, options, context);
                EXPECT_EQ(shared_cells(level, l, options.masks), 0u);
                const double share = bytes_of(l.atlas, per_texel) / static_cast<double>(options.atlas_bytes);
                EXPECT_LE(share, 1.0);
                // Pages are whole cells of 4 x 4 under two mips: a row of a page of 300 texels is 1.3 % of it.
                EXPECT_GE(share, 0.96);
            }
}

TEST(Atlas, TooFewBytesNameTheLeast) {
    const Level level = mixed_level();
    Context context(1);
    const auto atlas_of = [&](const ChartOptions& options) {
        const WorldGeometry geometry = flatten(level.scene, context).value();
        const ChartSet charts = make_charts(level.scene, geometry, options, context).value();
        return make_atlas(level.scene, geometry, charts, options, context);
    };
    ChartOptions options;
    options.texel_budget = 8000;  // also what tells which charts are bad
    options.atlas_bytes = 10;
    const Result<Atlas> none = atlas_of(options);
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().code, ErrorCode::usage);
    const std::string& remedy = none.error().remedy;
    options.atlas_bytes = std::stoull(remedy.substr(remedy.find_first_of("0123456789")));
    const Result<Atlas> least = atlas_of(options);
    ASSERT_TRUE(least.ok()) << least.error().text();
    EXPECT_EQ(bytes_of(*least, 1.0), static_cast<double>(options.atlas_bytes));
    --options.atlas_bytes;
    EXPECT_FALSE(atlas_of(options).ok());
    options.atlas_bytes = 80000;
    options.texels_per_metre = 4.0;
    EXPECT_EQ(atlas_of(options).error().code, ErrorCode::usage);
    options.texels_per_metre = 0.0;
    options.resolution_width = options.resolution_height = 256;
    EXPECT_EQ(atlas_of(options).error().code, ErrorCode::usage);
}

TEST(Atlas, BytesGiveTheSameBitsForAnyNumberOfThreads) {
    const Level level = mixed_level();
    const auto lay_out = [&](unsigned threads) {
        Context context(threads);
        ChartOptions options;
        options.atlas_bytes = 50000;
        return layout(level, options, context).atlas;
    };
    const Atlas one = lay_out(1), eight = lay_out(8);
    EXPECT_EQ(one.density, eight.density);
    ASSERT_EQ(one.placements.size(), eight.placements.size());
    for (std::size_t k = 0; k < one.placements.size(); ++k) EXPECT_EQ(one.placements[k].box, eight.placements[k].box);
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

}  // namespace
}  // namespace lumel
