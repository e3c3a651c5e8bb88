// Layers of scenes whose texels are known: on the page, through a camera, as pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "inspect/draw.h"
#include "inspect/gbuffer.h"
#include "inspect/view.h"
#include "render/picture.h"
#include "support/charted_scene.h"

namespace lumel {
namespace {

constexpr double kDensity = 4.0;  // texels per metre
constexpr std::uint32_t kWidth = 32, kHeight = 24;

// A square of 4 x 4 m that faces up, of albedo 0.5, 0.25, 0.125, seen from above or from below.
Scene square() {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.25f, 0.125f}, {0, 3, 0});
    b.object("square", grey, [](Mesh& m) { test::add_quad(m, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}); });
    b.scene().sky.color = {1, 1, 1};
    return b.build();
}

struct Inspected {
    explicit Inspected(Scene scene, unsigned threads = 1, double density = kDensity)
        : context(threads), charted(std::move(scene), density, context) {
        pages = make_gbuffer(layout(), {}, {true, true}, context).value();
        coverage.assign(pages[0].texels.texel_at.size(), Coverage::baked);
    }
    [[nodiscard]] BakedLayout layout() const { return {charted.charts, charted.atlas, charted.traced.transport}; }
    [[nodiscard]] static TexelLayer layer(const std::string& name) {
        return *std::ranges::find(gbuffer_layers(), name, &TexelLayer::name);
    }
    [[nodiscard]] LayerPage page(const std::string& name) const {
        return gbuffer_layer(layer(name), layout(), pages[0], coverage);
    }
    [[nodiscard]] SeenSurfaces see(Vec3 eye, bool through_backs = false) {
        const test::TracedScene& traced = charted.traced;
        const Camera camera = look_at(eye, {0, 0, 0}, 0.6f);
        return see_surfaces(*traced.tracer, traced.geometry, camera, kWidth, kHeight, through_backs, context).value();
    }
    [[nodiscard]] LayerView view(const TexelLayer& of, const LayerPage& page, const SeenSurfaces& seen,
                                 ViewFilter filter) const {
        const test::TracedScene& traced = charted.traced;
        return look_up(of, std::span(&page, 1), traced.scene, traced.geometry, charted.charts, charted.atlas, seen,
                       filter);
    }
    [[nodiscard]] std::size_t texels_of(const std::string& layer, float value) const {
        const LayerPage p = page(layer);
        std::size_t count = 0;
        for (std::size_t i = 0; i < p.presence.size(); ++i)
            count += p.presence[i] == Presence::covered && p.values.data[i] == value ? 1 : 0;
        return count;
    }

    Context context;
    test::ChartedScene charted;
    std::vector<GBufferPage> pages;
    std::vector<Coverage> coverage;
};

constexpr Vec3 kAbove{0.1f, 8, 0.2f}, kBelow{0.1f, -8, 0.2f};
constexpr std::size_t kMiddle = kHeight / 2 * kWidth + kWidth / 2;

TEST(GBuffer, LayersAreWhatTheBakeKnows) {
    const Inspected inspected(square());
    const TexelBuffer& texels = inspected.pages[0].texels;
    const LayerPage position = inspected.page("position"), normal = inspected.page("normal");
    const LayerPage face = inspected.page("face-normal"), size = inspected.page("texel-size");
    const LayerPage albedo = inspected.page("albedo"), emission = inspected.page("emission");
    ASSERT_GT(texels.size(), 200u);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const std::uint32_t x = texels.x[i], y = texels.y[i];
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(position.values.at(x, y)[c], texels.position[i][c]);
        EXPECT_EQ(normal.values.at(x, y)[1], 1.0f);
        EXPECT_EQ(face.values.at(x, y)[1], 1.0f);
        EXPECT_FLOAT_EQ(size.values.at(x, y)[0], 1.0f / static_cast<float>(kDensity));
        EXPECT_FLOAT_EQ(albedo.values.at(x, y)[1], 0.25f);
        EXPECT_FLOAT_EQ(emission.values.at(x, y)[1], 3.0f);
    }
    const auto covered = static_cast<std::size_t>(std::ranges::count(position.presence, Presence::covered));
    EXPECT_EQ(covered, texels.size());
}

TEST(GBuffer, EveryLayerFillsItsPage) {
    const Inspected inspected(square());
    for (const TexelLayer& layer : gbuffer_layers()) {
        const LayerPage page = inspected.page(layer.name);
        EXPECT_EQ(page.values.channels, layer.channels.size()) << layer.name;
        for (const float v : page.values.data) EXPECT_TRUE(std::isfinite(v)) << layer.name;
        EXPECT_EQ(std::ranges::count(page.presence, Presence::covered), std::ssize(inspected.pages[0].texels.x));
    }
}

// A box hides the texels under it, of which those that lookups from beside it read are moved there.
TEST(GBuffer, TexelsThatAreMovedAreTold) {
    enum { kUsual, kFlat, kPart, kLookups, kHidden, kFilled };  // as the layer lists them
    const Inspected open(square());
    EXPECT_EQ(open.texels_of("state", kUsual), open.pages[0].texels.size());

    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    b.object("square", grey, [](Mesh& m) { test::add_quad(m, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}); });
    b.object(
        "box", grey,
        [](Mesh& m) {
            test::add_box(m, {-0.96f, -0.5f, -0.96f}, {0.96f, 1, 0.96f}, false);
        },
        {}, NodeClass::volume);
    b.scene().sky.color = {1, 1, 1};
    Inspected boxed(b.build());
    // Centres of texels lie at multiples of 0.25 m. A texel is hidden up to 0.96 - 0.125 m from the middle: 7 x 7 of
    // them; lookups that read it reach as far as 0.25 m, so that of 5 x 5 nothing is read. The ring at 1 m is cut by
    // the box.
    EXPECT_EQ(boxed.texels_of("state", kHidden), 25u);
    EXPECT_EQ(boxed.texels_of("state", kLookups), 24u);
    EXPECT_EQ(boxed.texels_of("state", kPart), 32u);
    boxed.coverage[std::size_t{boxed.pages[0].texels.y[0]} * boxed.pages[0].texels.width + boxed.pages[0].texels.x[0]] =
        Coverage::filled;
    EXPECT_EQ(boxed.texels_of("state", kFilled), 1u);
}

// A facet of a ball, and a foil between it and the ball (PathIntegrator.SmoothPositionsStopAtObstacles).
TEST(GBuffer, TexelsThatStayFlatAreTold) {
    for (const bool blocked : {false, true}) {
        test::SceneBuilder b;
        const auto white = b.material({0.5f, 0.5f, 0.5f}, {}, true);
        b.object("facet", white, [](Mesh& m) {
            test::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
            for (std::size_t i = 0; i < 4; ++i) m.normals[i] = normalize(m.positions[i] + Vec3{0, 2, 0});
        });
        if (blocked)
            b.object(
                "foil", white,
                [](Mesh& m) {
                    test::add_quad(m, {-1, 0.02f, 1}, {2, 0, 0}, {0, 0, -2});
                },
                {}, NodeClass::volume);
        b.scene().sky.color = {1, 1, 1};
        const Inspected inspected(b.build());
        const LayerPage lift = inspected.page("smooth-lift");
        EXPECT_GT(*std::ranges::max_element(lift.values.data), 0.1f);
        const LayerPage share = inspected.page("flat-share");
        const float most = *std::ranges::max_element(share.values.data);
        EXPECT_EQ(most, blocked ? 1.0f : 0.0f);
    }
}

TEST(GBuffer, SliversAreCovered) {
    enum { kWhole, kRim, kThin };
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    // A hundredth of a texel wide.
    b.object("sliver", grey, [](Mesh& m) { test::add_quad(m, {-2, 0, 0}, {4, 0, 0}, {0, 0, -0.0025f}); });
    b.scene().sky.color = {1, 1, 1};
    const Inspected inspected(b.build());
    ASSERT_GE(inspected.pages[0].texels.size(), 16u);  // 4 m at 4 texels a metre
    EXPECT_EQ(inspected.texels_of("coverage", kWhole), 0u);
    EXPECT_GT(inspected.texels_of("coverage", kThin) + inspected.texels_of("coverage", kRim), 15u);
}

TEST(LayerView, ShowsTexelsBacksAndWhatIsNoSurface) {
    Inspected inspected(square());
    const TexelLayer layer = Inspected::layer("albedo");
    const LayerPage page = inspected.page("albedo");
    const LayerView above = inspected.view(layer, page, inspected.see(kAbove), ViewFilter::bilinear);
    EXPECT_EQ(above.shown[kMiddle], Shown::texel);
    EXPECT_FLOAT_EQ(above.values.data[3 * kMiddle], 0.5f);
    const LayerView below = inspected.view(layer, page, inspected.see(kBelow), ViewFilter::bilinear);
    EXPECT_EQ(below.shown[kMiddle], Shown::back);
    const LayerView through = inspected.view(layer, page, inspected.see(kBelow, true), ViewFilter::bilinear);
    EXPECT_EQ(through.shown[kMiddle], Shown::nothing);
    EXPECT_GT(std::ranges::count(above.shown, Shown::nothing), 10);  // beside the square
}

// Light that rises along x: bilinear and bicubic lookups show the ramp itself, point lookups steps of a texel.
TEST(LayerView, FiltersBlendAsTheirNamesSay) {
    Inspected inspected(square());
    TexelLayer layer{"ramp", "", "", ColorRule::heat, {"Y"}, {}, true};
    LayerPage page = inspected.page("texel-size");
    const TexelBuffer& texels = inspected.pages[0].texels;
    for (std::size_t i = 0; i < texels.size(); ++i) *page.values.at(texels.x[i], texels.y[i]) = texels.position[i].x;
    const SeenSurfaces seen = inspected.see(kAbove);
    const test::TracedScene& traced = inspected.charted.traced;
    const auto worst = [&](ViewFilter filter) {
        const LayerView view = inspected.view(layer, page, seen, filter);
        float out = 0.0f;
        for (std::size_t i = 0; i < seen.hits.size(); ++i) {
            const Hit& hit = seen.hits[i];
            if (view.shown[i] != Shown::texel) continue;
            const Vec3 p = traced.geometry.position(hit.triangle, hit.b1, hit.b2);
            const float rim = 2.0f - 2.5f / static_cast<float>(kDensity);  // beyond which filters reach past the chart
            if (std::fabs(p.x) > rim || std::fabs(p.z) > rim) continue;
            out = std::max(out, std::fabs(view.values.data[i] - p.x));
        }
        return out;
    };
    const float half_texel = 0.5f / static_cast<float>(kDensity);
    EXPECT_LT(worst(ViewFilter::bilinear), 1e-4f);  // rounding of places of some metres
    EXPECT_LT(worst(ViewFilter::bicubic), 1e-4f);
    EXPECT_GT(worst(ViewFilter::point), 0.8f * half_texel);
    EXPECT_LT(worst(ViewFilter::point), 1.01f * half_texel);
}

// At the rim of a chart a renderer blends with what is dilated, or with nothing; the g-buffer with its own texels.
TEST(LayerView, WithoutDilationTheRimOfAChartIsDark) {
    Inspected inspected(square());
    TexelLayer layer{"even", "", "", ColorRule::heat, {"Y"}, {}, true};
    LayerPage page = inspected.page("texel-size");
    std::ranges::fill(page.values.data, 1.0f);
    for (Presence& presence : page.presence)
        if (presence == Presence::none) presence = Presence::dilated;
    const SeenSurfaces seen = inspected.see(kAbove);
    const auto least = [&](const LayerPage& of) {
        // Charts end at centres of texels, so that bilinear lookups take little from beyond them; these take a sixth.
        const LayerView view = inspected.view(layer, of, seen, ViewFilter::bicubic);
        float out = 1.0f;
        for (std::size_t i = 0; i < view.shown.size(); ++i)
            if (view.shown[i] == Shown::texel) out = std::min(out, view.values.data[i]);
        return out;
    };
    EXPECT_NEAR(least(page), 1.0f, 1e-5f);  // shares sum to 1 but for rounding
    page.drop_dilated();
    EXPECT_LT(least(page), 0.9f);
    layer.is_looked_up = false;
    EXPECT_NEAR(least(page), 1.0f, 1e-5f);
}

bool has_color(const Image& image, Vec3 color) {
    for (std::size_t i = 0; i < image.data.size(); i += 3)
        if (length(Vec3{image.data[i], image.data[i + 1], image.data[i + 2]} - color) < 1e-6f) return true;  // rounded
    return false;
}

TEST(DrawLayer, EachPictureHasALegendOfItsColours) {
    Inspected inspected(square());
    const TexelLayer layer = Inspected::layer("state");
    const std::vector<LayerPage> pages{inspected.page("state")};
    const ColorScale scale(layer, pages);
    const Image page = draw_page(layer, pages[0], scale, "page 0");
    EXPECT_GE(page.width, pages[0].values.width);
    EXPECT_GT(page.height, pages[0].values.height);
    for (const Category& category : layer.categories) EXPECT_TRUE(has_color(page, category.color)) << category.name;
    EXPECT_FALSE(has_color(page, kBackColor));
    const LayerView view = inspected.view(layer, pages[0], inspected.see(kBelow), ViewFilter::point);
    const Image picture = draw_view(layer, view, scale, "view 0");
    EXPECT_EQ(picture.at(kWidth / 2, kHeight / 2)[0], kBackColor.x);
    EXPECT_EQ(picture.at(kWidth / 2, kHeight / 2)[1], kBackColor.y);
}

TEST(DrawLayer, WhatIsNoNumberIsMarked) {
    Inspected inspected(square());
    const TexelLayer layer = Inspected::layer("texel-size");
    std::vector<LayerPage> pages{inspected.page("texel-size")};
    EXPECT_FALSE(has_color(draw_page(layer, pages[0], ColorScale(layer, pages), ""), kNotFiniteColor));
    const TexelBuffer& texels = inspected.pages[0].texels;
    *pages[0].values.at(texels.x[5], texels.y[5]) = NAN;
    EXPECT_TRUE(has_color(draw_page(layer, pages[0], ColorScale(layer, pages), ""), kNotFiniteColor));
}

TEST(GBuffer, SameBitsForAnyThreads) {
    const Inspected one(test::room(), 1), three(test::room(), 3);
    for (const TexelLayer& layer : gbuffer_layers())
        EXPECT_EQ(one.page(layer.name).values.data, three.page(layer.name).values.data) << layer.name;
}

}  // namespace
}  // namespace lumel
