#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "base/hash.h"
#include "chart/chart_set.h"
#include "light/light_set.h"
#include "lumel/bake.h"
#include "path/path_integrator.h"
#include "post/lightmap.h"
#include "support/scene_builder.h"
#include "texel/texel_buffer.h"
#include "trace/tracer.h"

namespace lumel {
namespace {

// A room with one side open to the sky, a box and a ball of few facets in it, a lamp, a sun and a point light: every
// kind of path.
Scene room() {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.7f});
    const auto red = b.material({0.7f, 0.1f, 0.1f}, {}, true);
    const auto lamp = b.material({0.1f, 0.1f, 0.1f}, {20, 15, 10});
    b.object("room", white, [](Mesh& m) {
        test::add_quad(m, {0, 0, 2}, {3, 0, 0}, {0, 0, -2});
        test::add_quad(m, {0, 0, 0}, {3, 0, 0}, {0, 2, 0});
        test::add_quad(m, {0, 0, 2}, {0, 0, -2}, {0, 2, 0});
    });
    const auto box = b.object(
        "box", red,
        [](Mesh& m) {
            test::add_box(m, {-0.3f, 0, -0.3f}, {0.3f, 0.6f, 0.3f}, false);
        },
        Affine{{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {1, 0, 1}});
    b.instance("box 2", b.scene().instances[box].mesh, Affine{{Vec3{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {2.2f, 0, 0.8f}});
    b.object("lamp", lamp, [](Mesh& m) { test::add_quad(m, {1, 1.9f, 1}, {0.4f, 0, 0}, {0, 0, 0.4f}); });
    Light& sun = b.light(LightShape::sun);
    sun.direction = normalize(Vec3{-0.5f, -1.0f, -0.4f});
    sun.intensity = {5, 4, 3};
    sun.angular_diameter = 0.1f;
    Light& point = b.light(LightShape::point);
    point.position = {2.5f, 1.5f, 1.5f};
    point.intensity = {1, 2, 3};
    b.scene().sky.color = {0.4f, 0.6f, 1.0f};
    return b.build();
}

BakeOptions small_options() {
    BakeOptions options;
    options.texels_per_metre = 8;
    options.samples = 100;  // not a multiple of the wavefront
    options.bounces = 6;
    return options;
}

void hash_sums(Hasher& hasher, const RadianceSums& sums) {
    hasher.array(std::span(std::as_const(sums.layers)));
    hasher.array(std::span(std::as_const(sums.variance)));
    hasher.array(std::span(std::as_const(sums.bent_normal)));
    hasher.array(std::span(std::as_const(sums.sky_visibility)));
    hasher.array(std::span(std::as_const(sums.ambient_occlusion)));
    hasher.array(std::span(std::as_const(sums.count)));
    hasher.array(std::span(std::as_const(sums.traced)));
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
    const Result<BakeReport> result = bake(room(), options, sink, context);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
    if (report && result.ok()) *report = *result;
    return hasher.finish().hex();
}

TEST(Bake, TheSameBitsForOneTwoAndEightThreads) {
    BakeReport report;
    const std::string one = bake_hash(1, small_options(), &report);
    ASSERT_GT(report.texels, 500u);
    ASSERT_GT(report.mean_irradiance[0], 0.1);
    EXPECT_EQ(one, bake_hash(2, small_options()));
    EXPECT_EQ(one, bake_hash(8, small_options()));
    BakeOptions other = small_options();
    other.seed = 2;
    EXPECT_NE(one, bake_hash(2, other)) << "the hash sees nothing";
}

TEST(Bake, TheSameBitsForTheSeedsStopRule) {
    BakeOptions options = small_options();
    options.samples = 640;
    options.stop = StopRule::flux;
    BakeReport report;
    EXPECT_EQ(bake_hash(1, options, &report), bake_hash(2, options));
    EXPECT_LT(report.samples, report.texels * 640) << "no texel stopped early";
    EXPECT_GE(report.samples, report.texels * 64) << "the rule is looked at no sooner than at 10 %";
}

// The room and what its paths are traced through.
struct TracedRoom {
    Scene scene = room();
    WorldGeometry geometry;
    SurfaceReader surfaces{scene, geometry};
    LightSet lights{scene, geometry, surfaces};
    std::unique_ptr<Tracer> tracer;
    Transport transport{scene, geometry, surfaces, lights, *tracer};

    explicit TracedRoom(Context& context)
        : geometry(flatten(scene, context).value()), tracer(make_embree_tracer(geometry, surfaces, context).value()) {}
};

TEST(Bake, AnySplitOfTheTexelsGivesTheSameBits) {
    Context context(2);
    const TracedRoom traced(context);
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
    path.samples = 64;
    path.bounces = 4;

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
                merged.count[i] = part.count[i];
                merged.traced[i] = part.traced[i];
            }
        }
        EXPECT_EQ(hash_of(whole), hash_of(merged)) << shards << " shards";
    }
}

// A picture shows the layers that the bake's files sum, scaled alike.
TEST(Bake, IrradianceOfPicturesIsTheScaledSumOfLayers) {
    Context context(1);
    const TracedRoom traced(context);
    const Transport& transport = traced.transport;
    std::array<PathStart, kWavefrontLanes> starts;
    for (std::uint32_t i = 0; i < kWavefrontLanes; ++i) starts[i] = {{1.5f, 1e-3f, 1.5f}, {0, 1, 0}, 1, i};
    const auto sum_of = [&](std::array<float, kLayerCount> layer_scale) {
        PathOptions path;
        path.bounces = 4;
        path.layer_scale = layer_scale;
        const PathIntegrator integrator(transport, path);
        const auto workspace = integrator.make_workspace();
        std::array<Vec3, kWavefrontLanes> irradiance;
        std::array<std::uint8_t, kWavefrontLanes> valid;
        integrator.gather_irradiance(starts, *workspace, irradiance, valid);
        Vec3 sum{};
        for (const Vec3 i : irradiance) sum += i;
        return sum;
    };
    const Vec3 direct = sum_of({1, 0, 0}), sky = sum_of({0, 1, 0}), indirect = sum_of({0, 0, 1});
    for (const Vec3 layer : {direct, sky, indirect}) EXPECT_GT(layer.x, 0.0f);
    const Vec3 all = sum_of({1, 1, 1}), scaled = sum_of({2, 0.5f, 3});
    const Vec3 expected_all = direct + sky + indirect, expected_scaled = direct * 2.0f + sky * 0.5f + indirect * 3.0f;
    // The same few hundred numbers summed in another order: rounding stays below 1e-5.
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(all[c], expected_all[c], 1e-5f * expected_all[c]);
        EXPECT_NEAR(scaled[c], expected_scaled[c], 1e-5f * expected_scaled[c]);
    }
}

TEST(Lighting, SkyIntensityAndRotationActOnTheScenesOwnSky) {
    Scene scene = room();
    scene.sky.rotation = 0.25f;
    BakeOptions options;
    options.sky.intensity = 2;
    options.sky.rotation_degrees = 90;
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    EXPECT_EQ(scene.sky.color, (Vec3{0.8f, 1.2f, 2.0f}));
    EXPECT_FLOAT_EQ(scene.sky.rotation, 0.25f + 1.57079633f);
}

TEST(Lighting, TheOptionsSkyReplacesTheScenes) {
    Scene scene = room();
    scene.sky.rotation = 0.25f;
    BakeOptions options;
    options.sky.color = Vec3{1, 2, 3};
    options.sky.intensity = 2;
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    EXPECT_EQ(scene.sky.color, (Vec3{2, 4, 6}));
    EXPECT_EQ(scene.sky.rotation, 0.0f);
}

TEST(Lighting, TooBrightIsAnErrorThatNamesTheRemedy) {
    for (const double intensity : {2e12, 3e38, 1e300}) {
        Scene scene = room();
        scene.sky.map = SkyMap{2, 1, {Vec3{1, 1, 1}, Vec3{1, 10, 1}}};
        BakeOptions options;
        options.sky.intensity = intensity;
        options.sky.blur_degrees = 5;
        const Status status = apply_lighting(scene, options);
        ASSERT_FALSE(status.ok()) << intensity;
        EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
        EXPECT_NE(status.error().text().find("--sky-intensity"), std::string::npos) << status.error().text();

        scene = room();
        BakeOptions sun;
        sun.sun.direction = Vec3{0, -1, 0};
        sun.sun.illuminance = intensity;
        const Status bright_sun = apply_lighting(scene, sun);
        ASSERT_FALSE(bright_sun.ok()) << intensity;
        EXPECT_NE(bright_sun.error().text().find("--sun-direction"), std::string::npos) << bright_sun.error().text();
    }
}

TEST(Lighting, TheSunsDirectionMayHaveAnyLength) {
    for (const float length : {1e-30f, 1.0f, 1e30f}) {
        Scene scene = room();
        BakeOptions options;
        options.sun.direction = Vec3{0, -3, 4} * length;
        ASSERT_TRUE(apply_lighting(scene, options).ok()) << length;
        EXPECT_NEAR(scene.lights.back().direction.y, -0.6f, 1e-6f) << length;
        EXPECT_NEAR(scene.lights.back().direction.z, 0.8f, 1e-6f) << length;
    }
}

TEST(Bake, NoLightIsAnErrorThatNamesTheRemedy) {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f});
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}); });
    Context context(1);
    BakeSink sink{[](const auto&, const auto&, const auto&) { return success(); },
                  [](const auto&) { return success(); }};
    const auto result = bake(b.build(), {}, sink, context);
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().text().find("--sky"), std::string::npos);
}

TEST(Bake, TooLittleMemoryIsAnErrorThatSaysHowMuchIsNeeded) {
    BakeOptions options = small_options();
    options.max_memory_bytes = 1 << 20;
    Context context(1);
    BakeSink sink{[](const auto&, const auto&, const auto&) { return success(); },
                  [](const auto&) { return success(); }};
    const auto result = bake(room(), options, sink, context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::out_of_memory);
    EXPECT_NE(result.error().message.find("needs about"), std::string::npos);
}

TEST(Bake, CancelledBakesStopAndSaySo) {
    Context context(2);
    BakeSink sink{[&](const auto&, const auto&, const auto&) {
                      context.request_cancel();
                      return success();
                  },
                  [](const auto&) { return success(); }};
    const auto result = bake(room(), small_options(), sink, context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
