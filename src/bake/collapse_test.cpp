#include "bake/collapse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lumel/bake.h"
#include "support/scene_builder.h"
#include "support/statistics.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

// One chart of 8 x 8 texels whose light is `light(x, y)`, white unless told otherwise.
struct OneChart {
    Atlas atlas;
    Lightmap page;

    template <class Light>
    explicit OneChart(const Light& light, float variance = 0.0f) {
        constexpr std::uint32_t kSide = 8;
        atlas.pages = {{kSide, kSide}};
        atlas.placements = {{0, {1, 1}, {}, {0, 0, kSide, kSide}}};
        page.width = page.height = kSide;
        const std::size_t texels = std::size_t{kSide} * kSide;
        page.texels.resize(texels);
        page.chart.assign(texels, 0);
        page.coverage.assign(texels, Coverage::baked);
        page.surface.albedo.assign(texels, Vec3{1, 1, 1});
        page.surface.emission.assign(texels, Vec3{});
        page.normal.assign(texels, Vec3{0, 0, 1});
        for (std::uint32_t i = 0; i < texels; ++i) {
            page.texel_at.push_back(i);
            const float value = light(i % kSide, i / kSide);
            page.texels.layers[i][0].irradiance = Vec3{value, value, value};
            page.texels.layers[i][0].sh[0] = Vec3{value, value, value} * 1.7724539f;
            page.texels.variance[i] = Vec3{variance, variance, variance};
        }
    }
    [[nodiscard]] bool is_even(double share, bool has_noise = true) const {
        CollapseRule rule;
        rule.share = share;
        rule.has_noise = has_noise;
        return even_charts(std::span(&page, 1), atlas, rule)[0];
    }
};

float one(std::uint32_t, std::uint32_t) { return 1.0f; }

TEST(EvenCharts, SpreadDecides) {
    EXPECT_TRUE(OneChart(one).is_even(0.01));
    // From 1 - a to 1 + a in eight steps: a root mean square of 0.655 a.
    const auto slope = [](float a) {
        return [a](std::uint32_t x, std::uint32_t) { return 1.0f + a * (static_cast<float>(x) / 3.5f - 1.0f); };
    };
    EXPECT_TRUE(OneChart(slope(0.014f)).is_even(0.01));
    EXPECT_FALSE(OneChart(slope(0.018f)).is_even(0.01));
    EXPECT_TRUE(OneChart(slope(0.018f)).is_even(0.02));
}

TEST(EvenCharts, ABrightSpotIsNotLost) {
    const auto spot = [](std::uint32_t x, std::uint32_t y) { return x == 3 && y == 3 ? 1.06f : 1.0f; };
    EXPECT_FALSE(OneChart(spot).is_even(0.01)) << "0.75 % as a root mean square, but 6 % at one texel";
}

TEST(EvenCharts, NoiseIsNoSpreadWhereItIsKnown) {
    test::Random random(1);
    std::vector<float> noise;
    for (int i = 0; i < 64; ++i) {
        float sum = 0.0f;  // of twelve: a variance of 1
        for (int k = 0; k < 12; ++k) sum += random.unit();
        noise.push_back(sum - 6.0f);
    }
    const auto noisy = [&](std::uint32_t x, std::uint32_t y) { return 1.0f + 0.02f * noise[y * 8 + x]; };
    EXPECT_FALSE(OneChart(noisy, 0.0004f).is_even(0.01, false));
    EXPECT_FALSE(OneChart(noisy, 0.0004f).is_even(0.01)) << "64 texels do not tell 1 % beside a noise of 2 %";
    EXPECT_TRUE(OneChart(noisy, 0.0004f).is_even(0.02));
}

TEST(EvenCharts, LightOfOneSideIsNotThatOfAnother) {
    OneChart chart(one);
    for (std::size_t i = 0; i < chart.page.chart.size(); ++i)
        chart.page.texels.layers[i][0].sh[2] = Vec3{1, 1, 1} * (i % 8 < 4 ? 0.5f : -0.5f);
    EXPECT_FALSE(chart.is_even(0.01)) << "the irradiance is even, where it comes from is not";
}

TEST(EvenCharts, TexturesCountWhereTheyAreLit) {
    const auto paint = [](OneChart chart) {
        for (std::size_t i = 0; i < chart.page.chart.size(); i += 2)
            chart.page.surface.albedo[i] = Vec3{0.2f, 0.2f, 0.2f};
        return chart;
    };
    EXPECT_FALSE(paint(OneChart(one)).is_even(0.01));
    EXPECT_TRUE(paint(OneChart([](std::uint32_t, std::uint32_t) { return 0.0f; })).is_even(0.01));
}

// ---- A whole bake ---------------------------------------------------------------------------------------------------

// The room and, beside it, a hollow box that no light gets into, looked at from inside.
Scene room_with_a_dark_box() {
    Scene scene = test::room();
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    b.object("hollow", grey, [](Mesh& m) { test::add_box(m, {10, 0, 0}, {12, 2, 2}, true); });
    const Scene dark = b.build();
    const auto mesh = static_cast<std::uint32_t>(scene.meshes.size());
    const auto material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.insert(scene.materials.end(), dark.materials.begin(), dark.materials.end());
    Mesh hollow = *dark.meshes[0];
    for (Primitive& p : hollow.primitives) p.material += material;
    scene.meshes.push_back(std::make_shared<const Mesh>(std::move(hollow)));
    Instance instance = dark.instances[0];
    instance.mesh = mesh;
    scene.instances.push_back(instance);
    scene.display.meshes = scene.meshes;
    scene.display.instances.push_back({{}, mesh, static_cast<std::uint32_t>(scene.instances.size() - 1)});
    return scene;
}

struct BakedPages {
    ChartSet charts;
    Atlas atlas;
    std::vector<Lightmap> pages;
    BakeReport report;
};

BakedPages bake_with(const Scene& scene, double collapse, unsigned threads = 2) {
    BakeOptions options;
    options.texels_per_metre = 8;
    options.samples = 16;
    options.bounces = 2;
    options.collapse = collapse;
    BakedPages out;
    BakeSink sink;
    sink.layout = [&](const WorldGeometry&, const ChartSet& charts, const Atlas& atlas) {
        out.charts = charts;
        out.atlas = atlas;
        return success();
    };
    sink.page = [&](const Lightmap& page) {
        out.pages.push_back(page);
        return success();
    };
    Context context(threads);
    const Result<BakeReport> report = bake(scene, options, sink, context);
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().text());
    if (report.ok()) out.report = *report;
    return out;
}

std::uint64_t page_texels(const Atlas& atlas) {
    std::uint64_t sum = 0;
    for (const AtlasPage& page : atlas.pages) sum += std::uint64_t{page.width} * page.height;
    return sum;
}

TEST(Collapse, EvenChartsShrinkAndTheOthersKeepTheirBits) {
    const Scene scene = room_with_a_dark_box();
    const BakedPages before = bake_with(scene, 0.0), after = bake_with(scene, 0.01);
    ASSERT_EQ(before.atlas.placements.size(), after.atlas.placements.size());
    EXPECT_GE(after.report.collapsed_charts, 1u);
    EXPECT_LT(after.report.collapsed_charts, after.atlas.placements.size());
    EXPECT_LT(page_texels(after.atlas), page_texels(before.atlas));
    std::uint64_t smaller = 0, same = 0;
    for (std::size_t k = 0; k < after.atlas.placements.size(); ++k) {
        const ChartPlacement &a = before.atlas.placements[k], &b = after.atlas.placements[k];
        const Lightmap &from = before.pages[a.page], &to = after.pages[b.page];
        if (b.box.width != a.box.width || b.box.height != a.box.height) {
            EXPECT_EQ(b.box.width * b.box.height, 4u);
            ++smaller;
            for (std::uint32_t y = 0; y < 2; ++y)
                for (std::uint32_t x = 0; x < 2; ++x) {
                    const std::uint32_t texel = to.texel_at[(b.box.y + y) * to.width + b.box.x + x];
                    ASSERT_NE(texel, kNone);
                    EXPECT_EQ(to.chart[texel], k);
                    EXPECT_EQ(to.coverage[texel], Coverage::baked);
                }
            continue;
        }
        for (std::uint32_t y = 0; y < a.box.height; ++y)
            for (std::uint32_t x = 0; x < a.box.width; ++x) {
                const std::uint32_t i = from.texel_at[(a.box.y + y) * from.width + a.box.x + x];
                if (i == kNone || from.chart[i] != k || from.coverage[i] < Coverage::filled) continue;
                const std::uint32_t j = to.texel_at[(b.box.y + y) * to.width + b.box.x + x];
                ASSERT_NE(j, kNone);
                EXPECT_EQ(to.chart[j], k);
                EXPECT_EQ(to.coverage[j], from.coverage[i]);
                for (std::size_t l = 0; l < kLayerCount; ++l) {
                    EXPECT_EQ(to.texels.layers[j][l].irradiance, from.texels.layers[i][l].irradiance);
                    EXPECT_EQ(to.texels.layers[j][l].sh, from.texels.layers[i][l].sh);
                }
                ++same;
            }
    }
    EXPECT_EQ(smaller, after.report.collapsed_charts);
    EXPECT_GT(same, 1000u);
}

TEST(Collapse, SameBitsForAnyNumberOfThreads) {
    const Scene scene = room_with_a_dark_box();
    const BakedPages one = bake_with(scene, 0.05, 1), eight = bake_with(scene, 0.05, 8);
    ASSERT_EQ(one.pages.size(), eight.pages.size());
    for (std::size_t p = 0; p < one.pages.size(); ++p) {
        EXPECT_EQ(one.pages[p].texel_at, eight.pages[p].texel_at);
        for (std::size_t i = 0; i < one.pages[p].chart.size(); ++i)
            EXPECT_EQ(one.pages[p].texels.layers[i][0].irradiance, eight.pages[p].texels.layers[i][0].irradiance);
    }
}

TEST(Collapse, SaysWhatItDoesNotGoWith) {
    BakeOptions options;
    options.collapse = 0.01;
    options.resolution_width = options.resolution_height = 64;
    Context context(1);
    const Result<BakeReport> report = bake(test::room(), options, {}, context);
    ASSERT_FALSE(report.ok());
    EXPECT_NE(report.error().text().find("--resolution"), std::string::npos);
}

}  // namespace
}  // namespace lumel
