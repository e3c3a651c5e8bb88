#include "post/fit_lookup.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/flat_page.h"

namespace lumel {
namespace {

// A page whose texels hold the means of `light`, a function of place in texels, at the points that they gather from.
struct GatheredPage {
    test::BakedPage page;
    Lightmap map;

    template <class Light>
    GatheredPage(const test::FlatPage& flat, Light&& light) : page(flat) {
        RadianceSums sums;
        sums.resize(page.texels.size());
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums.count[i] = sums.open[i] = 64;
            const std::vector<SamplePoint> points = page.samples(i);
            for (const SamplePoint& p : points) {
                const auto uv = page.uv(p.triangle);
                const Vec2 at = uv[0] * (1.0f - p.b1 - p.b2) + uv[1] * p.b1 + uv[2] * p.b2;
                sums.layers[i][1].irradiance += Vec3{1, 0, 2} * (light(at) / static_cast<float>(points.size()));
            }
            sums.layers[i][1].sh[0] = sums.layers[i][1].irradiance * 3.0f;
        }
        TexelSurface surface;
        surface.albedo.resize(sums.size());
        surface.emission.resize(sums.size());
        map = finish_page(page.texels, std::move(sums), std::move(surface), {}, 2, page.context).value();
    }

    Status fit() { return fit_to_lookup(page.texels, {}, map, page.context); }

    [[nodiscard]] float at(std::uint32_t x, std::uint32_t y) const {
        const std::uint32_t texel = map.texel_at[std::size_t{y} * map.width + x];
        return texel == kNone ? NAN : map.texels.layers[texel][1].irradiance.x;
    }
    [[nodiscard]] float look_up(Vec2 p) const {
        const float x = p.x - 0.5f, y = p.y - 0.5f;
        const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
        const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
        return (at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx) * (1 - fy) +
               (at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx) * fy;
    }
};

// A chart whose border lies on the centres of texels, as make_atlas places it.
test::FlatPage strip(float steps_across, float steps_along) {
    test::FlatPage flat;
    flat.add_quad({3.5f, 3.5f}, {steps_across, 0}, {0, steps_along});
    return flat;
}

TEST(FitToLookup, EvenLightStaysAsItIs) {
    GatheredPage page(strip(3, 5), [](Vec2) { return 2.0f; });
    ASSERT_TRUE(page.fit().ok());
    for (std::size_t i = 0; i < page.map.texels.size(); ++i)
        EXPECT_NEAR(page.map.texels.layers[i][1].irradiance.x, 2.0f, 1e-5f);
}

// Two texels across: they hold the light a quarter of the strip from its borders, half of the contrast.
TEST(FitToLookup, AStripOfTwoTexelsKeepsItsContrast) {
    const auto light = [](Vec2 p) { return p.x - 2.5f; };  // 1 on one border, 2 on the other
    GatheredPage page(strip(1, 6), light);
    const Vec2 left{3.5f, 6.0f}, right{4.499f, 6.0f};
    ASSERT_NEAR(page.look_up(right) - page.look_up(left), 0.5f, 0.02f);
    ASSERT_TRUE(page.fit().ok());
    // A lookup at the points leaves 1/2 of what alternates across. Of the correction by 1 that is missing, damping by
    // 0.1 lets (1/2)^2 / ((1/2)^2 + 0.1) through: contrast 0.5 * 1.714.
    EXPECT_NEAR(page.look_up(right) - page.look_up(left), 0.857f, 0.02f);
    EXPECT_NEAR(page.look_up({4.0f, 6.0f}), 1.5f, 0.01f);
}

TEST(FitToLookup, BringsLookupsNearerToTheLightOnARimAcrossTexels) {
    const auto light = [](Vec2 p) { return 1.0f + 0.1f * (p.x - 3.5f) * (p.x - 3.5f) + 0.05f * p.y; };
    test::FlatPage flat;
    flat.add({Vec2{3.5f, 3.5f}, {11.5f, 3.5f}, {3.5f, 11.5f}});
    GatheredPage page(flat, light);
    const auto error = [&] {
        double sum = 0.0;
        for (int i = 0; i < 32; ++i)
            for (int j = 0; i + j < 32; ++j) {
                const Vec2 p{3.5f + 0.2499f * static_cast<float>(i), 3.5f + 0.2499f * static_cast<float>(j)};
                sum += std::pow(static_cast<double>(page.look_up(p) - light(p)), 2);
            }
        return sum;
    };
    const double before = error();
    ASSERT_TRUE(page.fit().ok());
    EXPECT_LT(error(), 0.5 * before);
}

// A shadow edge is sharpened, within bounds; what is black stays so, and nothing gets below zero.
TEST(FitToLookup, AShadowStaysBlack) {
    GatheredPage page(strip(9, 4), [](Vec2 p) { return p.x < 8.0f ? 0.0f : 1.0f; });
    const Lightmap before = page.map;
    ASSERT_TRUE(page.fit().ok());
    for (std::size_t i = 0; i < before.texels.size(); ++i) {
        const float was = before.texels.layers[i][1].irradiance.x, is = page.map.texels.layers[i][1].irradiance.x;
        EXPECT_GE(is, 0.25f * was);
        EXPECT_LE(is, 2.0f * was);
    }
    EXPECT_EQ(page.at(4, 5), 0.0f);
}

TEST(FitToLookup, HarmonicsAreScaledWithTheIrradiance) {
    GatheredPage page(strip(1, 6), [](Vec2 p) { return p.x; });
    ASSERT_TRUE(page.fit().ok());
    for (std::size_t i = 0; i < page.map.texels.size(); ++i) {
        const LayerMoments& light = page.map.texels.layers[i][1];
        EXPECT_NEAR(light.sh[0].x, 3.0f * light.irradiance.x, 1e-5f);
        EXPECT_NEAR(light.irradiance.z, 2.0f * light.irradiance.x, 1e-5f);
        EXPECT_EQ(light.irradiance.y, 0.0f);
    }
}

TEST(FitToLookup, ChartsSideBySideDoNotMix) {
    test::FlatPage flat;
    flat.add_quad({3, 3}, {4, 0}, {0, 4}, 0);
    flat.add_quad({7, 3}, {4, 0}, {0, 4}, 1);
    GatheredPage page(flat, [](Vec2 p) { return p.x < 7.0f ? 1.0f : 5.0f; });
    ASSERT_TRUE(page.fit().ok());
    for (std::size_t i = 0; i < page.map.texels.size(); ++i)
        EXPECT_NEAR(page.map.texels.layers[i][1].irradiance.x, page.map.chart[i] == 0 ? 1.0f : 5.0f, 1e-4f);
}

TEST(FitToLookup, CanBeCancelled) {
    GatheredPage page(strip(3, 5), [](Vec2 p) { return p.x; });
    page.page.context.request_cancel();
    const Status status = page.fit();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
