// Floors of several pieces: where their seams are found, and that both sides come to show the same.
#include <gtest/gtest.h>

#include <cmath>

#include "seam/blend_seams.h"
#include "support/scene_builder.h"
#include "support/traced_scene.h"
#include "texel/texel_buffer.h"

namespace lumel {
namespace {

// Three tiles of different instances, at height 0 unless said otherwise: one of 2 m, beside it two of 1 m, whose edges
// meet its long one in a T-junction. Seams: 2 m along the long edge and 1 m between the small ones.
// `thickness`: of the wall, metres; 0: a sheet.
Scene tiles(bool wall = false, float step = 0.0f, float width = 1.0f, float thickness = 0.0f) {
    test::SceneBuilder builder;
    const std::uint32_t grey = builder.material({0.5f, 0.5f, 0.5f}, {}, true);
    const auto tile = [&](const char* name, Vec3 origin, Vec3 u, Vec3 v) {
        builder.object(name, grey, [&](Mesh& mesh) { test::add_quad(mesh, origin, u, v); });
    };
    tile("long", {0, 0, 0}, {0, 0, 2}, {width, 0, 0});
    tile("near", {width, step, 0}, {0, 0, 1}, {width, 0, 0});
    tile("far", {width, step, 1}, {0, 0, 1}, {width, 0, 0});
    if (wall && thickness == 0.0f) tile("wall", {1, 0, 0}, {0, 0, 2}, {0, 1, 0});
    if (wall && thickness > 0.0f)
        builder.object("wall", grey, [&](Mesh& mesh) {
            test::add_box(mesh, {1 - 0.5f * thickness, 0, 0}, {1 + 0.5f * thickness, 1, 2}, false);
        });
    return builder.build();
}

struct Layout {
    Context context{1};
    test::TracedScene traced;
    ChartSet charts;
    Atlas atlas;
    std::vector<BorderEdge> edges;

    explicit Layout(Scene scene, std::uint32_t max_page = 4096) : traced(std::move(scene), context) {
        ChartOptions options;
        options.uv1 = Uv1Policy::ignore;
        options.texels_per_metre = 24.0;
        options.max_page = max_page;
        charts = make_charts(traced.scene, traced.geometry, options, context).value();
        atlas = make_atlas(traced.scene, traced.geometry, charts, options, context).value();
        edges = find_border_edges(traced.scene, traced.geometry, charts, atlas);
    }
    [[nodiscard]] SeamSamples samples() {
        const SeamRule rule;
        const auto seams = find_seams(edges, rule, context).value();
        return make_seam_samples(edges, seams, rule, 2.0f, traced.transport.tracer, context).value();
    }
    // Light that is 1 + instance in the direct layer, and twice that of the sky.
    [[nodiscard]] Lightmap page(std::uint32_t index) {
        const auto triangles = triangles_by_page(traced.scene, traced.geometry, charts, atlas);
        const TexelBuffer texels =
            rasterize_page(traced.scene, traced.geometry, charts, atlas, index, triangles[index], context).value();
        RadianceSums sums;
        sums.resize(texels.size());
        for (std::size_t i = 0; i < texels.size(); ++i) {
            const float light = 1.0f + static_cast<float>(texels.chart[i]);
            sums.open[i] = sums.count[i] = 1;
            for (const std::size_t l : {0u, 1u}) {
                sums.layers[i][l].irradiance = Vec3{light, light, light} * (l == 0 ? 1.0f : 2.0f);
                sums.layers[i][l].sh[0] = sums.layers[i][l].irradiance;
            }
        }
        TexelSurface surface{std::vector<Vec3>(texels.size()), std::vector<Vec3>(texels.size())};
        return finish_page(texels, std::move(sums), std::move(surface), {}, 2, context).value();
    }
};

float look_up(const Lightmap& map, const SeamPoint& point, std::size_t layer) {
    float sum = 0.0f;
    lookup_at(LookupFilter::bilinear, point.texels)
        .for_each(map.width, map.height, [&](std::uint32_t x, std::uint32_t y, float share) {
            sum += share * map.texels.layers[map.texel_at[std::size_t{y} * map.width + x]][layer].irradiance.x;
        });
    return sum;
}

double metres_of(const std::vector<BorderEdge>& edges, const std::vector<Seam>& seams) {
    double sum = 0.0;
    for (const Seam& s : seams)
        sum += static_cast<double>(length(position_at(edges[s.a], s.a_to) - position_at(edges[s.a], s.a_from)));
    return sum;
}

TEST(BorderEdges, AreAsManyAsWereCounted) {
    for (const bool wall : {false, true}) {
        const Layout layout(tiles(wall));
        ASSERT_GE(layout.edges.size(), 12u);
        EXPECT_EQ(count_border_edges(layout.traced.scene, layout.charts), layout.edges.size());
    }
}

TEST(FindSeams, FindsEdgesOfInstancesAndTJunctions) {
    Layout layout(tiles());
    const auto seams = find_seams(layout.edges, {}, layout.context).value();
    EXPECT_EQ(seams.size(), 3u);
    EXPECT_NEAR(metres_of(layout.edges, seams), 3.0, 1e-5);
}

TEST(FindSeams, LeavesOutWhatIsFartherThanTheRuleOrTurnedAway) {
    Layout stepped(tiles(false, 0.002f));  // twice the distance: only the small tiles still meet
    EXPECT_NEAR(metres_of(stepped.edges, find_seams(stepped.edges, {}, stepped.context).value()), 1.0, 1e-5);
    test::SceneBuilder builder;
    const std::uint32_t grey = builder.material({0.5f, 0.5f, 0.5f});
    builder.object("box", grey, [](Mesh& mesh) { test::add_box(mesh, {0, 0, 0}, {1, 1, 1}, false); });
    Layout box(builder.build());
    EXPECT_GE(box.edges.size(), 24u);
    EXPECT_TRUE(find_seams(box.edges, {}, box.context).value().empty());
}

TEST(SeamSamples, AreLeftOutWhereAWallStandsOnTheSeam) {
    Layout open(tiles());
    const SeamSamples all = open.samples();
    EXPECT_EQ(all.hidden, 0u);
    // Thicker ones hide what lookups carry beside the seam.
    for (const float texels : {0.0f, 0.7f, 1.5f, 2.9f}) {
        Layout parted(tiles(true, 0.0f, 1.0f, texels / 24.0f));
        const SeamSamples some = parted.samples();
        // 2 m of 3 stand below the wall, at two samples for each of 24 texels.
        EXPECT_GE(some.hidden, 2u * 48u) << texels;
        EXPECT_LT(some.samples.size(), all.samples.size() / 2) << texels;
    }
}

TEST(BlendSeams, MakesBothSidesEqualAndLeavesTheRest) {
    Layout layout(tiles());
    const SeamSamples samples = layout.samples();
    ASSERT_GT(samples.samples.size(), 100u);
    Lightmap map = layout.page(0);
    const Lightmap before = map;
    ASSERT_TRUE(SeamBlender(samples.samples, layout.atlas, {}).blend(map, layout.context).ok());

    std::vector<bool> touched(map.texels.size());
    double worst = 0.0, worst_before = 0.0;
    for (const SeamSample& s : samples.samples) {
        const auto contrast = [&](const Lightmap& m) {
            return std::fabs(double{look_up(m, s.a, 0)} - look_up(m, s.b, 0));
        };
        worst = std::max(worst, contrast(map));
        worst_before = std::max(worst_before, contrast(before));
        for (const SeamPoint& p : {s.a, s.b})
            lookup_at(LookupFilter::bilinear, p.texels)
                .for_each(map.width, map.height, [&](std::uint32_t x, std::uint32_t y, float) {
                    touched[map.texel_at[std::size_t{y} * map.width + x]] = true;
                });
    }
    EXPECT_GE(worst_before, 1.0);  // whole steps between the tiles
    EXPECT_LT(worst, 0.02);        // hold and tolerance leave a hundredth of the largest, at the corner of all three
    std::size_t left = 0;
    for (std::size_t i = 0; i < touched.size(); ++i) {
        if (touched[i]) continue;
        ++left;
        EXPECT_EQ(map.texels.layers[i][0].irradiance, before.texels.layers[i][0].irradiance);
    }
    EXPECT_GT(left, map.texels.size() / 2);
    // One map for all layers: twice the light stays twice the light (rounding of some hundred sums).
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        EXPECT_NEAR(map.texels.layers[i][1].irradiance.x, 2.0f * map.texels.layers[i][0].irradiance.x, 1e-4f);
}

TEST(BlendSeams, NeverLeavesNegativeLight) {
    Layout layout(tiles());
    Lightmap map = layout.page(0);
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        if (map.chart[i] == 0)
            for (LayerMoments& layer : map.texels.layers[i]) layer = {};
    ASSERT_TRUE(SeamBlender(layout.samples().samples, layout.atlas, {}).blend(map, layout.context).ok());
    for (const auto& layers : map.texels.layers)
        for (const LayerMoments& layer : layers) {
            EXPECT_GE(layer.irradiance.x, 0.0f);
            EXPECT_GE(layer.sh[0].x, 0.0f);
        }
}

// |R1| <= R0 in the coefficients: l1^2 + l2^2 + l3^2 <= 3 l0^2. All light is from one direction, but for every other
// texel of one tile, whose is from the opposite, as bright: lookups on its edges show none of the two, and to show what
// the other side does, its other texels would have to go beyond. Nothing but this rule holds them back.
TEST(BlendSeams, NeverLeavesVectorsLongerThanTheLight) {
    const float rim = std::sqrt(3.0f);
    for (const float width : {0.96f, 0.97f, 0.98f, 0.99f, 1.0f}) {
        Layout layout(tiles(false, 0.0f, width));
        Lightmap map = layout.page(0);
        for (std::size_t pixel = 0; pixel < map.texel_at.size(); ++pixel) {
            const std::uint32_t i = map.texel_at[pixel];
            if (i == kNone) continue;
            const bool opposite = map.chart[i] == 0 && (pixel % map.width + pixel / map.width) % 2 == 1;
            for (LayerMoments& layer : map.texels.layers[i]) {
                layer = {};
                layer.irradiance = layer.sh[0] = {1, 1, 1};
                layer.sh[2] = Vec3{rim, rim, rim} * (opposite ? -1.0f : 1.0f);
            }
        }
        const Lightmap before = map;
        ASSERT_TRUE(SeamBlender(layout.samples().samples, layout.atlas, {}).blend(map, layout.context).ok());
        std::size_t moved = 0;
        for (std::size_t i = 0; i < map.texels.size(); ++i)
            for (std::size_t l = 0; l < kLayerCount; ++l) {
                const LayerMoments& layer = map.texels.layers[i][l];
                moved += layer.sh[2] == before.texels.layers[i][l].sh[2] ? 0 : 1;
                double squares = 0.0;
                for (const std::size_t k : {1u, 2u, 3u}) squares += double{layer.sh[k].x} * double{layer.sh[k].x};
                const double l0 = double{layer.sh[0].x};
                ASSERT_LE(squares, 3.0 * l0 * l0 * 1.0002) << width;  // rounding of vectors on the rim
            }
        EXPECT_GT(moved, 100u);
    }
}

TEST(BlendSeams, LaterPagesAdaptToEarlierOnes) {
    Layout layout(tiles(false, 0.0f, 2.0f), 64);  // 48 x 96 texels: more than a page has
    ASSERT_GE(layout.atlas.pages.size(), 2u);
    const SeamSamples samples = layout.samples();
    SeamBlender blender(samples.samples, layout.atlas, {});
    std::vector<Lightmap> pages;
    for (std::uint32_t p = 0; p < layout.atlas.pages.size(); ++p) {
        pages.push_back(layout.page(p));
        ASSERT_TRUE(blender.blend(pages.back(), layout.context).ok());
    }
    std::size_t crossing = 0;
    for (const SeamSample& s : samples.samples) {
        crossing += s.a.page != s.b.page;
        EXPECT_NEAR(look_up(pages[s.a.page], s.a, 0), look_up(pages[s.b.page], s.b, 0), 0.03f);
    }
    EXPECT_GT(crossing, 20u);
}

TEST(BlendSeams, SameBitsForAnyNumberOfThreads) {
    Layout layout(tiles());
    const SeamSamples samples = layout.samples();
    Lightmap one = layout.page(0), many = one;
    ASSERT_TRUE(SeamBlender(samples.samples, layout.atlas, {}).blend(one, layout.context).ok());
    Context four(4);
    ASSERT_TRUE(SeamBlender(samples.samples, layout.atlas, {}).blend(many, four).ok());
    for (std::size_t i = 0; i < one.texels.size(); ++i)
        for (std::size_t l = 0; l < kLayerCount; ++l) {
            EXPECT_EQ(one.texels.layers[i][l].irradiance, many.texels.layers[i][l].irradiance);
            EXPECT_EQ(one.texels.layers[i][l].sh, many.texels.layers[i][l].sh);
        }
}

TEST(LookupFilter, SharesSumToOneAndBicubicIsSymmetric) {
    for (const LookupFilter filter : {LookupFilter::bilinear, LookupFilter::bicubic}) {
        float sum = 0.0f, x_mean = 0.0f;
        lookup_at(filter, {10.3f, 7.9f}).for_each(32, 32, [&](std::uint32_t x, std::uint32_t, float share) {
            sum += share;
            x_mean += share * (static_cast<float>(x) + 0.5f);
        });
        EXPECT_NEAR(sum, 1.0f, 1e-6f);
        EXPECT_NEAR(x_mean, 10.3f, 1e-4f);  // both filters reproduce even slopes
    }
}

}  // namespace
}  // namespace lumel
