#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "path/path_integrator.h"
#include "path/texel_sink.h"
#include "support/light_checks.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

struct Gathered {
    std::vector<Vec3> irradiance;
    std::vector<std::uint8_t> met_back;
};

Gathered gather(const Transport& transport, const PathOptions& options, std::span<const PathStart> starts) {
    const PathIntegrator integrator(transport, options);
    const auto workspace = integrator.make_workspace();
    Gathered out{std::vector<Vec3>(starts.size()), std::vector<std::uint8_t>(starts.size())};
    integrator.gather_irradiance(starts, *workspace, out.irradiance, out.met_back);
    return out;
}

// Paths from one point, sample by sample of one point set.
std::vector<PathStart> starts_at(Vec3 origin, Vec3 normal, std::uint32_t count) {
    std::vector<PathStart> starts;
    for (std::uint32_t i = 0; i < count; ++i) starts.push_back({origin, normal, 1, i});
    return starts;
}

// A picture shows the layers that the bake's files sum, scaled alike.
TEST(PathIntegrator, IrradianceIsTheScaledSumOfLayers) {
    Context context(1);
    const test::TracedScene traced(test::room(), context);
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
        integrator.gather_irradiance(starts, *workspace, irradiance);
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

// A path is a function of its start alone: whatever else is in its batch, and however full that is.
TEST(PathIntegrator, APathDoesNotDependOnItsBatch) {
    Context context(1);
    const test::TracedScene traced(test::room(), context);
    PathOptions options;
    options.bounces = 8;
    const auto starts = starts_at({1.5f, 1e-3f, 1.5f}, {0, 1, 0}, kWavefrontLanes);
    const Gathered all = gather(traced.transport, options, starts);
    for (const std::size_t first : {std::size_t{0}, std::size_t{100}, std::size_t{255}})
        for (const std::size_t count : {std::size_t{1}, std::size_t{13}}) {
            const auto part = std::span(starts).subspan(first, std::min(count, starts.size() - first));
            const Gathered some = gather(traced.transport, options, part);
            for (std::size_t i = 0; i < part.size(); ++i)
                EXPECT_EQ(some.irradiance[i], all.irradiance[first + i]) << first << " + " << i;
        }
}

TEST(PathIntegrator, WithoutBouncesThereIsNoIndirectLightAndTheRestIsTheSame) {
    Context context(1);
    const test::TracedScene traced(test::room(), context);
    const auto starts = starts_at({1.5f, 1e-3f, 1.5f}, {0, 1, 0}, kWavefrontLanes);
    const auto mean = [&](std::uint32_t bounces, std::array<bool, kLayerCount> included) {
        PathOptions options;
        options.bounces = bounces;
        options.included = included;
        Vec3 sum{};
        for (const Vec3 i : gather(traced.transport, options, starts).irradiance) sum += i;
        return sum;
    };
    EXPECT_EQ(mean(0, {false, false, true}), Vec3{});
    EXPECT_EQ(mean(0, {true, true, false}), mean(8, {true, true, false}));
    // One bounce more is light more, in a room of any reflectance; the paths before it are the same.
    const float one = mean(1, {false, false, true}).x, two = mean(2, {false, false, true}).x;
    EXPECT_GT(one, 0.0f);
    EXPECT_GT(two, one);
}

// A black plate above the start, looked at from behind: it takes its form factor of the sky away whether it is
// double-sided or not; only of the one that is not is it told that it was met.
TEST(PathIntegrator, BacksOfSingleSidedSurfacesAreBlackAndTold) {
    Context context(1);
    for (const bool double_sided : {false, true}) {
        test::SceneBuilder b;
        const auto black = b.material({0, 0, 0}, {}, double_sided);
        b.object("plate", black, [](Mesh& m) { test::add_quad(m, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2}); });  // faces up
        b.scene().sky.color = {1, 1, 1};
        const test::TracedScene traced(b.build(), context);
        constexpr std::uint32_t kPaths = 256;
        const Gathered g = gather(traced.transport, {}, starts_at({0, 0, 0}, {0, 1, 0}, kPaths));
        double sum = 0, met_back = 0;
        for (std::uint32_t i = 0; i < kPaths; ++i) {
            sum += static_cast<double>(g.irradiance[i].x);
            met_back += g.met_back[i];
        }
        // Form factor of the plate seen from below its middle, by Howell's factor 11 (B-4) times four.
        constexpr double kFormFactor = 0.554142;
        EXPECT_NEAR(sum / kPaths, 1.0 - kFormFactor, 0.05);  // 256 stratified paths: below 0.01 of noise
        if (double_sided) {
            EXPECT_EQ(met_back, 0);
        } else {
            // The plate fills a third of the solid angle and more than half of the cosine-weighted one.
            EXPECT_GT(met_back, 0.2 * kPaths);
            EXPECT_LT(met_back, 0.6 * kPaths);
        }
    }
}

TEST(PathIntegrator, StartsAreLiftedToTheSideThatIsAsked) {
    Context context(1);
    const test::TracedScene traced(test::room(), context);
    const PathIntegrator integrator(traced.transport, {});
    const auto workspace = integrator.make_workspace();
    const std::array<SamplePoint, 2> points{{{0, 0.25f, 0.25f}, {0, 0.25f, 0.25f}}};  // of the floor
    const std::array<std::uint8_t, 2> back{0, 1};
    std::array<SurfaceStart, 2> starts;
    integrator.surface_starts(points, back, *workspace, starts);
    EXPECT_EQ(starts[0].normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(starts[1].normal, (Vec3{0, -1, 0}));
    EXPECT_GT(starts[0].origin.y, 0.0f);
    EXPECT_LT(starts[1].origin.y, 0.0f);
    for (const SurfaceStart& start : starts) EXPECT_EQ(start.skip, 0u);
}

// A facet of a ball: its points are lifted towards the ball that its normals describe, unless something is between.
TEST(PathIntegrator, SmoothPositionsStopAtObstacles) {
    Context context(1);
    for (const bool blocked : {false, true}) {
        test::SceneBuilder b;
        const auto white = b.material({0.5f, 0.5f, 0.5f}, {}, true);
        b.object("facet", white, [](Mesh& m) {
            test::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
            for (std::size_t i = 0; i < 4; ++i) m.normals[i] = normalize(m.positions[i] + Vec3{0, 2, 0});
        });
        // Between the facet and the ball.
        if (blocked) b.object("foil", white, [](Mesh& m) { test::add_quad(m, {-1, 0.02f, 1}, {2, 0, 0}, {0, 0, -2}); });
        b.scene().sky.color = {1, 1, 1};
        const test::TracedScene traced(b.build(), context);
        const PathIntegrator integrator(traced.transport, {});
        const auto workspace = integrator.make_workspace();
        const std::array<SamplePoint, 1> point{{{0, 1.0f / 3, 1.0f / 3}}};
        std::array<SurfaceStart, 1> start;
        integrator.surface_starts(point, std::array<std::uint8_t, 1>{0}, *workspace, start);
        if (blocked)
            EXPECT_LT(start[0].origin.y, 0.02f);
        else
            EXPECT_GT(start[0].origin.y, 0.1f);
    }
}

// Known samples, known moments: three paths of value 1, 2, 3 and one that met a back first but was reached by a light.
TEST(TexelSink, MeanAndErrorAreThoseOfAllSamples) {
    PathOptions options;
    TexelSink sink(options);
    std::vector<PathStart> starts(4);
    for (PathStart& start : starts) start.normal = {0, 0, 1};
    sink.begin(starts, 1.0f);
    const Vec3 up{0, 0, 1};
    const auto pi = static_cast<float>(M_PI);
    for (std::uint32_t lane = 0; lane < 3; ++lane)
        sink.light(lane, Layer::sky, up, Vec3{1, 1, 1} * (pi * static_cast<float>(lane + 1)));
    sink.back(3, 1.0f);
    sink.light(3, Layer::sky, up, Vec3{1, 1, 1} * (pi * 2.0f));
    sink.end();
    RadianceSums sums;
    sums.resize(1);
    sink.store(sums, 0);
    EXPECT_EQ(sums.open[0], 3u);
    EXPECT_EQ(sums.count[0], 4u);
    const float mean = 2.0f;
    EXPECT_NEAR(sums.layers[0][1].irradiance.x, mean, 1e-6f);
    EXPECT_NEAR(sums.variance[0].x, 2.0 / (4.0 * 3.0), 1e-6);  // sum (x - mean)^2 / (n (n - 1))
}

// The choice of the light changes the noise and nothing else.
TEST(PathIntegrator, TreeAndPowerAgreeAndTheTreeIsQuieter) {
    Context context(1);
    test::SceneBuilder b;
    const auto white = b.material({0.6f, 0.6f, 0.6f});
    const auto lamp = b.material({0, 0, 0}, {3, 2, 1});
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {-20, 0, 20}, {40, 0, 0}, {0, 0, -40}); });
    for (int i = 0; i < 30; ++i)
        b.object("lamp", lamp, [&](Mesh& m) {
            test::add_quad(m, {static_cast<float>(i) - 15.0f, 1.5f, 0}, {0.3f, 0, 0}, {0, 0, 0.3f});
        });
    Light& point = b.light(LightShape::point);
    point.position = {2.5f, 1.5f, 1.5f};
    point.intensity = {0.1f, 0.2f, 0.3f};
    const test::TracedScene traced(b.build(), context);
    const LightSet by_power(traced.scene, traced.geometry, traced.surfaces, LightSet::Choice::power);
    const Transport power{traced.scene, traced.geometry, traced.surfaces, by_power, *traced.tracer};
    PathOptions options;
    options.bounces = 2;
    constexpr std::uint32_t kPaths = 16384;
    const auto moments = [&](const Transport& transport) {
        test::Moments m;
        const auto starts = starts_at({0.5f, 1e-3f, 0.2f}, {0, 1, 0}, kPaths);
        for (std::uint32_t first = 0; first < kPaths; first += kWavefrontLanes)
            for (const Vec3 i :
                 gather(transport, options, std::span(starts).subspan(first, kWavefrontLanes)).irradiance)
                m.add(static_cast<double>(i.x));
        return m;
    };
    const test::Moments tree = moments(traced.transport), reference = moments(power);
    // Independent samples overstate the error of these stratified ones; 5 standard errors all the same.
    const double error = std::sqrt((tree.variance() + reference.variance()) / kPaths);
    EXPECT_NEAR(tree.mean(), reference.mean(), 5.0 * error);
    EXPECT_LT(error, 0.05 * reference.mean()) << "too noisy to tell anything";
    EXPECT_LT(tree.variance(), 0.3 * reference.variance());
}

TEST(TransportOptions, AreThoseOfTheBake) {
    BakeOptions bake;
    bake.bounces = 7;
    bake.seed = 99;
    bake.direct_scale = 2.0;
    bake.indirect_scale = 3.0;
    bake.include = {false, true, true};
    const PathOptions path = transport_options(bake);
    EXPECT_EQ(path.bounces, 7u);
    EXPECT_EQ(path.seed, 99u);
    EXPECT_EQ(path.layer_scale, (std::array<float, 3>{2, 2, 3}));
    EXPECT_EQ(path.included, (std::array<bool, 3>{false, true, true}));
}

}  // namespace
}  // namespace lumel
