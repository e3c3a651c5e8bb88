// The same bits, whoever shares the work.
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "base/hash.h"
#include "chart/chart_set.h"
#include "lumel/bake.h"
#include "path/gather_page.h"
#include "path/path_integrator.h"
#include "post/lightmap.h"
#include "support/small_bake.h"
#include "support/traced_scene.h"
#include "texel/texel_buffer.h"

namespace lumel {
namespace {

void hash_sums(Hasher& hasher, const RadianceSums& sums) {
    hasher.array(std::span(std::as_const(sums.layers)));
    hasher.array(std::span(std::as_const(sums.variance)));
    hasher.array(std::span(std::as_const(sums.bent_normal)));
    hasher.array(std::span(std::as_const(sums.sky_visibility)));
    hasher.array(std::span(std::as_const(sums.ambient_occlusion)));
    hasher.array(std::span(std::as_const(sums.open)));
    hasher.array(std::span(std::as_const(sums.count)));
}

std::string bake_hash(unsigned threads, const BakeOptions& options, BakeReport* report = nullptr) {
    Context context(threads);
    Hasher hasher;
    BakeSink sink;
    sink.layout = [&](const WorldGeometry&, const ChartSet&, const Atlas& atlas) {
        for (const ChartPlacement& p : atlas.placements) hasher.pod(p.page).pod(p.offset.x).pod(p.offset.y);
        return success();
    };
    sink.page = [&](const Lightmap& map) {
        hash_sums(hasher, map.texels);
        return success();
    };
    const Result<BakeReport> result = bake(test::room(), options, sink, context);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
    if (report && result.ok()) *report = *result;
    return hasher.finish().hex();
}

TEST(Bake, MipsHaveTheSameBitsForOneAndEightThreads) {
    BakeOptions options = test::small_options();
    options.samples = 4;
    options.mips = 2;
    EXPECT_EQ(bake_hash(1, options), bake_hash(8, options));
}

TEST(Bake, TheSameBitsForOneTwoAndEightThreads) {
    BakeReport report;
    const std::string one = bake_hash(1, test::small_options(), &report);
    ASSERT_GT(report.texels, 500u);
    ASSERT_GT(report.cells, 10u);
    ASSERT_GT(report.mean_irradiance[0], 0.1);
    EXPECT_LT(std::fabs(report.cell_bias), 0.02 + 4.0 * report.cell_bias_error);
    EXPECT_EQ(one, bake_hash(2, test::small_options()));
    EXPECT_EQ(one, bake_hash(8, test::small_options()));
    BakeOptions other = test::small_options();
    other.seed = 2;
    EXPECT_NE(one, bake_hash(2, other)) << "the hash sees nothing";
}

TEST(Bake, SinglePathsTellNothingOfTheirError) {
    for (const std::uint32_t samples : {1u, 2u}) {
        BakeOptions options = test::small_options();
        options.texels_per_metre = 2;
        options.samples = samples;
        BakeReport report;
        bake_hash(1, options, &report);
        EXPECT_EQ(std::isnan(report.estimated_nrmse), samples == 1) << report.estimated_nrmse;
    }
}

TEST(Bake, TheSameBitsForTheSeedsStopRule) {
    BakeOptions options = test::small_options();
    options.samples = 640;
    options.stop = StopRule::flux;
    BakeReport report;
    EXPECT_EQ(bake_hash(1, options, &report), bake_hash(2, options));
    EXPECT_LT(report.samples, report.texels * 640) << "no texel stopped early";
    EXPECT_GE(report.samples, report.texels * 64) << "the rule is looked at no sooner than at 10 %";
}

TEST(Bake, TheSameBitsForTexelsThatStopAtAnError) {
    BakeOptions options = test::small_options();
    options.samples = 1024;
    options.stop = StopRule::error;
    options.error = 0.1;
    BakeReport report;
    EXPECT_EQ(bake_hash(1, options, &report), bake_hash(2, options));
    EXPECT_LT(report.samples, report.texels * 1024) << "no texel stopped early";
    EXPECT_GT(report.share_within_error, 0.5);
    EXPECT_LE(report.share_within_error, 1.0);
    EXPECT_LE(report.share_within_error + report.share_unlit + report.share_out_of_samples, 1.0 + 1e-12);
    options.stop = StopRule::fixed;
    options.samples = 64;
    bake_hash(1, options, &report);
    EXPECT_TRUE(std::isnan(report.share_within_error)) << "nothing was to be reached";
}

TEST(Bake, TheSamplesThatFittedATimeGiveTheSameBits) {
    BakeOptions options = test::small_options();
    options.samples = 512;
    options.time_seconds = 1e-3;
    BakeReport report;
    const std::string shortest = bake_hash(2, options, &report);
    EXPECT_EQ(report.samples_per_texel, 32u);
    options.time_seconds = 1e6;
    bake_hash(2, options, &report);
    EXPECT_EQ(report.samples_per_texel, 512u) << "the samples asked for are the most";
    options.time_seconds = 0.0;
    options.samples = 32;
    EXPECT_EQ(bake_hash(1, options), shortest);
}

TEST(Bake, AnySplitOfTheTexelsGivesTheSameBits) {
    Context context(2);
    const test::TracedScene traced(test::room(), context);
    const Scene& scene = traced.scene;
    const WorldGeometry& geometry = traced.geometry;
    const Transport& transport = traced.transport;
    ChartOptions chart_options;
    chart_options.texels_per_metre = 8;
    const ChartSet charts = make_charts(scene, geometry, chart_options, context).value();
    const Atlas atlas = make_atlas(scene, geometry, charts, chart_options, context).value();
    const auto by_page = triangles_by_page(scene, geometry, charts, atlas);
    const TexelBuffer texels = rasterize_page(scene, geometry, charts, atlas, 0, by_page[0], context).value();
    PathOptions path;
    path.samples = 96;
    path.bounces = 4;
    path.guided = true;

    const auto hash_of = [&](const RadianceSums& sums) {
        Hasher hasher;
        hash_sums(hasher, sums);
        return hasher.finish().hex();
    };
    const RadianceSums whole = gather_page(texels, charts, atlas, transport, path, 0, texels.size(), context).value();
    for (const std::size_t shards : {3u, 7u}) {
        RadianceSums merged;
        merged.resize(texels.size());
        for (std::size_t s = 0; s < shards; ++s) {
            const std::size_t first = texels.size() * s / shards, last = texels.size() * (s + 1) / shards;
            const RadianceSums part =
                gather_page(texels, charts, atlas, transport, path, first, last - first, context).value();
            for (std::size_t i = first; i < last; ++i) {
                merged.layers[i] = part.layers[i];
                merged.variance[i] = part.variance[i];
                merged.bent_normal[i] = part.bent_normal[i];
                merged.sky_visibility[i] = part.sky_visibility[i];
                merged.ambient_occlusion[i] = part.ambient_occlusion[i];
                merged.open[i] = part.open[i];
                merged.count[i] = part.count[i];
            }
        }
        EXPECT_EQ(hash_of(whole), hash_of(merged)) << shards << " shards";
    }
}

}  // namespace
}  // namespace lumel
