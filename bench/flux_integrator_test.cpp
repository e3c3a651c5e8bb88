#include "flux_integrator.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "methods.h"
#include "reference.h"
#include "support/statistics.h"
#include "support/traced_scene.h"

namespace lumel::bench {
namespace {

ChartOptions coarse() {
    ChartOptions options;
    options.texels_per_metre = 2.0;
    return options;
}

// Open at one side, with fronts wherever one looks: no path meets a back.
Scene room_without_backs() {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.7f}), red = b.material({0.7f, 0.1f, 0.1f});
    const auto lamp = b.material({0.1f, 0.1f, 0.1f}, {20, 15, 10});
    b.object("room", white, [](Mesh& m) {
        test::add_quad(m, {0, 0, 2}, {3, 0, 0}, {0, 0, -2});
        test::add_quad(m, {0, 0, 0}, {3, 0, 0}, {0, 2, 0});
        test::add_quad(m, {0, 0, 2}, {0, 0, -2}, {0, 2, 0});
        test::add_quad(m, {3, 0, 0}, {0, 0, 2}, {0, 2, 0});
        test::add_quad(m, {0, 2, 0}, {3, 0, 0}, {0, 0, 2});
    });
    b.object("shelf", red, [](Mesh& m) { test::add_box(m, {0.7f, 0.4f, 0.7f}, {1.3f, 0.8f, 1.3f}, false); });
    b.object("lamps", lamp, [](Mesh& m) {
        test::add_box(m, {1.8f, 1.4f, 0.8f}, {2.1f, 1.5f, 1.1f}, false);
        test::add_box(m, {0.4f, 1.2f, 0.4f}, {0.5f, 1.6f, 0.5f}, false);
    });
    Light& sun = b.light(LightShape::sun);
    sun.direction = normalize(Vec3{-0.5f, -0.8f, -0.9f});
    sun.intensity = {5, 4, 3};
    sun.angular_diameter = 0.1f;
    Light& point = b.light(LightShape::point);
    point.position = {2.5f, 1.5f, 1.5f};
    point.intensity = {1, 2, 3};
    Light& ball = b.light(LightShape::sphere);
    ball.position = {1.5f, 0.5f, 1.7f};
    ball.radius = 0.1f;
    ball.intensity = {3, 6, 9};
    b.scene().sky.color = {0.4f, 0.6f, 1.0f};
    return b.build();
}

// Means over the page: I, then L0 and L1, of three channels.
std::vector<double> page_means(const Method& method, const BenchScene& bench, std::uint64_t seed, std::uint32_t samples,
                               Context& context) {
    PathOptions path;
    path.samples = samples;
    path.seed = seed;
    path.bounces = 16;
    const RadianceSums sums = method.gather({bench, path, bench.middle_texels(0), context});
    std::vector<double> means(3 * (1 + kScoredSh));
    for (std::size_t t = 0; t < sums.size(); ++t) {
        EXPECT_EQ(sums.open[t], sums.count[t]);
        EXPECT_EQ(sums.count[t], samples);
        const TexelLight light = light_of(sums, t);
        for (std::size_t c = 0; c < 3; ++c) {
            means[c] += static_cast<double>(light.irradiance[c]) / static_cast<double>(sums.size());
            for (std::size_t k = 0; k < kScoredSh; ++k)
                means[3 * (k + 1) + c] += static_cast<double>(light.sh[k][c]) / static_cast<double>(sums.size());
        }
    }
    return means;
}

// A sky, a sun with an angle, a point, a ball, two lamps: in the mean the peer has the light that Lumel has, whatever
// its choices.
class FluxMean : public testing::TestWithParam<const char*> {};

TEST_P(FluxMean, AgreesWithLumels) {
    Context context(2);
    const BenchScene bench("room", room_without_backs(), coarse(), context);
    const Method *peer = find_method(GetParam()), *lumel = find_method("power");
    ASSERT_TRUE(peer && lumel);
    constexpr std::uint32_t kRuns = 40, kSamples = 24;
    std::vector<test::Moments> differences(3 * (1 + kScoredSh));
    std::vector<double> brightness(differences.size());
    for (std::uint32_t run = 0; run < kRuns; ++run) {
        const auto ours = page_means(*lumel, bench, 1000 + run, kSamples, context);
        const auto theirs = page_means(*peer, bench, 2000 + run, kSamples, context);
        for (std::size_t i = 0; i < ours.size(); ++i) {
            differences[i].add(theirs[i] - ours[i]);
            brightness[i] += ours[i] / kRuns;
        }
    }
    for (std::size_t i = 0; i < differences.size(); ++i) {
        EXPECT_TRUE(test::mean_agrees(differences[i], 0.0, 1e-4, differences.size())) << i << " of " << brightness[i];
        // Blunt means agree with anything.
        if (i < 6) {
            EXPECT_LT(differences[i].standard_error(), 0.006 * brightness[i]) << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, FluxMean,
                         testing::Values("flux-uniform", "flux-all", "flux-as-power", "flux-as-tree"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

RadianceSums gather_room(const FluxChoices& choices, const PathOptions& path, unsigned threads,
                         std::string_view method = {}) {
    Context context(threads);
    const BenchScene bench("room", test::room(), coarse(), context);
    if (!method.empty()) return find_method(method)->gather({bench, path, bench.middle_texels(0), context});
    const LightSet lights(bench.scene, bench.geometry, bench.surfaces);
    const FluxIntegrator integrator({bench.scene, bench.geometry, bench.surfaces, lights, *bench.tracer}, path,
                                    choices);
    const auto workspace = integrator.make_workspace();
    RadianceSums sums;
    sums.resize(bench.texels.size());
    std::array<SamplePoint, kSamplesPerTexel> points;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::uint32_t n =
            sample_points(bench.texels, i, bench.scene, bench.geometry, bench.charts, bench.atlas, points);
        integrator.gather_texel({std::span(points).first(n), i, bench.texels.world_size[i]}, *workspace, sums, i);
    }
    return sums;
}

// Its stop rule spends a tenth of the budget at least, stops some texels early and others not, and is as Lumel's: at a
// tenth of the budget where any error will do.
TEST(FluxIntegrator, StopsByItsRule) {
    PathOptions path;
    path.samples = 200;
    path.stop = StopRule::flux;
    path.relative_error_of_mean = 0.08;
    const auto traced = gather_room({}, path, 1).count;
    EXPECT_LT(*std::ranges::min_element(traced), 200u);
    EXPECT_EQ(*std::ranges::max_element(traced), 200u);
    for (const std::uint32_t t : traced) EXPECT_EQ(t % 20, 0u);
    path.relative_error_of_mean = 1e6;
    for (const std::uint32_t t : gather_room({}, path, 1).count) EXPECT_EQ(t, 20u);
}

TEST(FluxIntegrator, SameBitsOnAnyNumberOfThreads) {
    PathOptions path;
    path.samples = 32;
    const RadianceSums one = gather_room({}, path, 1, "flux-uniform"), three = gather_room({}, path, 3, "flux-uniform");
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i)
        for (std::size_t l = 0; l < kLayerCount; ++l)
            EXPECT_EQ(one.layers[i][l].irradiance, three.layers[i][l].irradiance) << i;
}

TEST(FluxLights, AreTheLightsAndTheEmittersThatHangTogether) {
    Context context(1);
    test::SceneBuilder b;
    const auto lamp = b.material({0, 0, 0}, {5, 5, 5});
    b.object("two lamps", lamp, [](Mesh& m) {
        test::add_box(m, {0, 0, 0}, {1, 1, 1}, false);
        test::add_box(m, {3, 0, 0}, {4, 1, 1}, false);
    });
    b.light(LightShape::point);
    b.light(LightShape::sun);
    b.light(LightShape::point).bake = LightBake::none;
    b.light(LightShape::spot).intensity = {};
    const test::TracedScene traced(b.build(), context);
    const FluxLights lights(traced.scene, traced.geometry, traced.surfaces);
    ASSERT_EQ(lights.size(), 4u);
    // Each of the two boxes gives points on its own faces, on all that are in sight.
    for (const std::size_t object : {2u, 3u}) {
        const float low = object == 2 ? 0.0f : 3.0f;
        test::Random random(1);
        std::set<std::uint32_t> met;
        for (int i = 0; i < 500; ++i) {
            const Vec3 from{low + 2.0f, 2.0f, 2.0f};
            const LightSample sample = lights.sample(object, from, random.pair());
            if (sample.distance <= 0.0f) continue;
            const Vec3 at = from + sample.direction * sample.distance;
            EXPECT_GE(at.x, low - 1e-4f);
            EXPECT_LE(at.x, low + 1.0f + 1e-4f);
            met.insert(sample.triangle);
        }
        EXPECT_EQ(met.size(), 6u);  // three faces of two triangles
    }
}

TEST(FluxNumbers, AreHaltonPointsThatEachTexelTurns) {
    // Niederreiter 1992, (3.2): digits mirrored at the point.
    EXPECT_EQ(radical_inverse(2, 6), 0.375f);
    EXPECT_NEAR(radical_inverse(3, 5), 7.0 / 9.0, 1e-7);
    EXPECT_EQ(radical_inverse(29, 0), 0.0f);
    EXPECT_LT(radical_inverse(2, 0xffffffffu), 1.0f);
    constexpr std::uint32_t kSamples = 256;
    const HaltonTable table(kSamples);
    // The first 255 are multiples of 1/256, each once, whatever the turn; turns differ from texel to texel.
    std::set<float> firsts;
    for (const std::uint32_t key : {1u, 2u, 99u}) {
        std::set<int> cells;
        const float first = FluxNumbers(table, FluxPoints::halton, key, 0).direction(0).x;
        for (std::uint32_t i = 0; i + 1 < kSamples; ++i) {
            const FluxNumbers numbers(table, FluxPoints::halton, key, i);
            const float x = numbers.direction(0).x, from_first = x - first + (x < first ? 1.0f : 0.0f);
            cells.insert(static_cast<int>(from_first * kSamples + 0.5f) % static_cast<int>(kSamples));
            for (std::uint32_t vertex = 0; vertex < 4; ++vertex)
                for (const float u : {numbers.direction(vertex).y, numbers.light_choice(vertex),
                                      numbers.on_light(vertex, 3).x, numbers.roulette(vertex), numbers.origin()}) {
                    EXPECT_GE(u, 0.0f);
                    EXPECT_LT(u, 1.0f);
                }
        }
        EXPECT_EQ(cells.size(), kSamples - 1);
        firsts.insert(first);
    }
    EXPECT_EQ(firsts.size(), 3u);
}

}  // namespace
}  // namespace lumel::bench
