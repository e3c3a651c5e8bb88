#include "path/light_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "math/discrete.h"
#include "support/charted_scene.h"
#include "support/meshes.h"
#include "support/scene_builder.h"

namespace lumel {
namespace {

// A floor and lights in a row above it.
Scene row_of_lights(const std::vector<Vec3>& intensities) {
    test::SceneBuilder b;
    b.object("floor", b.material({0.5f, 0.5f, 0.5f}), [](Mesh& m) {
        test::add_quad(m, {-4, 0, 1}, {8, 0, 0}, {0, 0, -2});
    });
    for (std::size_t i = 0; i < intensities.size(); ++i) {
        Light light;
        light.position = {static_cast<float>(i) - 0.5f * static_cast<float>(intensities.size() - 1), 1.0f, 0.0f};
        light.intensity = intensities[i];
        b.scene().lights.push_back(light);
    }
    return b.build();
}

struct Row {
    Context context{1};
    test::TracedScene traced;
    const LightSet& lights;
    std::array<ReceiverRegion, 1> texels{ReceiverRegion{{0, 0, 0}, {0, 1, 0}}};
    LightStatistics statistics;

    explicit Row(const std::vector<Vec3>& intensities)
        : traced(row_of_lights(intensities), context), lights(traced.transport.lights) {
        statistics.begin(lights, texels);
    }
    // Chances of the groups, which cover all numbers.
    std::vector<double> chances() {
        statistics.learn();
        const LightTable table = *statistics.table(0);
        EXPECT_EQ(table.ends.back(), kUnits);
        std::vector<double> out;
        for (std::size_t g = 0; g < table.ends.size(); ++g) out.push_back(table.units(g) / double{kUnits});
        return out;
    }
};

TEST(LightStatistics, BeginWithWhatTheTreeExpects) {
    Row row({{1, 1, 1}, {2, 2, 2}, {4, 4, 4}});
    const std::vector<double> chances = row.chances();
    ASSERT_EQ(chances.size(), 3u);
    double total = 0.0;
    for (std::size_t g = 0; g < 3; ++g) total += row.lights.importance_of(g, row.texels[0]);
    for (std::size_t g = 0; g < 3; ++g)
        EXPECT_NEAR(chances[g], row.lights.importance_of(g, row.texels[0]) / total, 1e-6) << g;
}

TEST(LightStatistics, HaveNothingToSayOfOneLightOrOfNone) {
    Row one({{1, 1, 1}});
    EXPECT_FALSE(one.statistics.table(0));
    LightStatistics never;
    EXPECT_FALSE(never.table(0));
    // All lights are behind the receiver.
    Row below({{1, 1, 1}, {1, 1, 1}});
    below.texels[0].axis = {0, -1, 0};
    below.statistics.begin(below.lights, below.texels);
    EXPECT_FALSE(below.statistics.table(0));
}

// A light that samples never reach keeps a tenth of what it had, and of the rest what the tree's word is worth against
// a thousand samples; what it leaves goes to the others.
TEST(LightStatistics, BlockedLightsLoseTheirShare) {
    Row row({{3, 3, 3}, {3, 3, 3}, {3, 3, 3}, {3, 3, 3}});
    const std::vector<double> before = row.chances();
    for (int i = 0; i < 4000; ++i) {
        const auto group = static_cast<std::uint32_t>(i % 4);
        row.statistics.add(0, group, group == 2 ? 0.0f : static_cast<float>(0.5 / before[group]));
    }
    const std::vector<double> after = row.chances();
    // The others bring 0.5 each. Of this one the tree's word, that it brings its part of the mean, counts for 4
    // samples.
    const double mean = (0.5 / before[0] + 0.5 / before[1] + 0.5 / before[3]) / 4.0;
    const double left = before[2] * mean * std::sqrt(4.0 / 1004.0);
    EXPECT_NEAR(after[2], 0.1 * before[2] + 0.9 * left / (left + 1.5), 0.01 * before[2]);
    for (const std::size_t g : {0u, 1u, 3u}) EXPECT_NEAR(after[g], 1.0 / 3.0, 0.05) << g;
}

// In proportion to what they bring, whatever the table said before, also where it said it over and over.
TEST(LightStatistics, FollowWhatLightsBring) {
    Row row({{1, 1, 1}, {1, 1, 1}});
    for (int round = 0; round < 4; ++round) {
        const std::vector<double> chances = row.chances();
        for (int i = 0; i < 1000; ++i)
            for (const std::uint32_t group : {0u, 1u})
                row.statistics.add(0, group, static_cast<float>((group == 0 ? 3.0 : 1.0) / chances[group]));
    }
    const std::vector<double> chances = row.chances();
    EXPECT_NEAR(chances[0], 0.1 * 0.5 + 0.9 * 0.75, 0.01);
}

// Lights without a size can only be sampled: none that could reach a texel may be lost.
TEST(LightStatistics, LeaveEachLightThatMustBeSampledAUnit) {
    Row row({{1e-9f, 1e-9f, 1e-9f}, {1e9f, 1e9f, 1e9f}});
    for (int i = 0; i < 100; ++i) row.statistics.add(0, 1, 1.0f);
    for (const double chance : row.chances()) EXPECT_GE(chance * kUnits, 1.0);
}

// Two rooms with a hundred lamps each, and a wall between them; above the ceiling as many, brighter ones.
Scene two_rooms() {
    test::SceneBuilder b;
    const auto white = b.material({0.6f, 0.6f, 0.6f});
    b.object("rooms", white, [](Mesh& m) {
        test::add_quad(m, {0, 0, 4}, {8, 0, 0}, {0, 0, -4});
        test::add_quad(m, {0, 3, 0}, {8, 0, 0}, {0, 0, 4});
        test::add_quad(m, {0, 0, 0}, {8, 0, 0}, {0, 3, 0});
        test::add_quad(m, {8, 0, 4}, {-8, 0, 0}, {0, 3, 0});
        test::add_quad(m, {0, 0, 4}, {0, 0, -4}, {0, 3, 0});
        test::add_quad(m, {8, 0, 0}, {0, 0, 4}, {0, 3, 0});
        test::add_quad(m, {3.9f, 0, 0}, {0, 0, 4}, {0, 3, 0});  // the wall, as a closed solid
        test::add_quad(m, {4.1f, 0, 4}, {0, 0, -4}, {0, 3, 0});
    });
    // Those of the other room and above could bring as much, and cannot be seen.
    for (int i = 0; i < 400; ++i) {
        const float x = i % 2 == 0 ? 0.4f : 4.4f, y = i % 4 < 2 ? 2.9f : 6.0f;
        const int k = i / 4;
        Light light;
        light.shape = LightShape::rectangle;
        light.position = {x + 0.35f * static_cast<float>(k % 10), y, 0.4f * static_cast<float>(k / 10) + 0.2f};
        light.direction = {0, -1, 0};
        light.half_u = {0.1f, 0, 0};
        light.half_v = {0, 0, 0.1f};
        light.intensity = Vec3{2, 2, 2} * (y > 3.0f ? 4.0f : 1.0f);
        b.scene().lights.push_back(light);
    }
    return b.build();
}

// Sums over all texels: of the mean of two runs, and of its squared error by their difference.
struct TwoRuns {
    double mean = 0.0, noise = 0.0;

    TwoRuns(const RadianceSums& a, const RadianceSums& b) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (!a.valid(i) || !b.valid(i)) continue;
            const double x = test::total_irradiance(a, i).y, y = test::total_irradiance(b, i).y;
            mean += 0.5 * (x + y);
            noise += 0.25 * (x - y) * (x - y);
        }
    }
};

RadianceSums gather_direct(const test::ChartedScene& scene, bool learned, std::uint64_t seed) {
    PathOptions path;
    path.bounces = 0;
    path.samples = 256;
    path.lights_learned = learned;
    path.seed = seed;
    return scene.gather(path);
}

TEST(LearnedLights, HaveTheSameMeanAndLessNoise) {
    Context context(2);
    const test::ChartedScene rooms(two_rooms(), 3, context);
    const TwoRuns plain(gather_direct(rooms, false, 1), gather_direct(rooms, false, 2)),
        learned(gather_direct(rooms, true, 3), gather_direct(rooms, true, 4));
    ASSERT_GT(plain.mean, 0.0);
    EXPECT_LT(learned.noise, 0.6 * plain.noise) << plain.noise;
    // Four deviations of the sums, by the noise itself.
    EXPECT_NEAR(learned.mean, plain.mean, 4.0 * std::sqrt(plain.noise + learned.noise));
}

// A light that reaches a part of a texel, but not the point that happens to be its first, must not be lost: the rim of
// a spot's cone, the end of a range, the horizon of a curved surface.
TEST(LearnedLights, ReachAllPointsOfATexel) {
    Context context(2);
    // Below a lamp that all of it sees.
    const auto floor = [](test::SceneBuilder& b) {
        b.object("floor", b.material({0.5f, 0.5f, 0.5f}), [](Mesh& m) {
            test::add_quad(m, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
        });
        Light lamp;
        lamp.position = {0, 3, 0};
        lamp.intensity = {9, 9, 9};
        b.scene().lights.push_back(lamp);
    };
    const auto spots = [&] {
        test::SceneBuilder b;
        floor(b);
        for (const float x : {-0.63f, 0.71f}) {
            Light light;
            light.shape = LightShape::spot;
            light.position = {x, 1, 0.11f};
            light.direction = {0, -1, 0};
            light.inner_cone = light.outer_cone = 0.5f;
            light.intensity = {4, 4, 4};
            b.scene().lights.push_back(light);
        }
        return b.build();
    };
    const auto ranges = [&] {
        test::SceneBuilder b;
        floor(b);
        for (const float x : {-0.63f, 0.71f}) {
            Light light;
            light.position = {x, 0.5f, 0.11f};
            light.range = 0.8f;
            light.intensity = {4, 4, 4};
            b.scene().lights.push_back(light);
        }
        return b.build();
    };
    const auto column = [] {
        test::SceneBuilder b;
        b.object("column", b.material({0.5f, 0.5f, 0.5f}), [](Mesh& m) {
            const Mesh shape = test::cylinder(24, 1.0f, 0.3f, 1.0f);
            m.positions = shape.positions;
            m.normals = shape.normals;
            m.triangles = shape.triangles;
        });
        for (const float x : {-0.9f, 0.8f}) {
            Light light;
            light.position = {x, 0.3f, 0.4f};
            light.intensity = {4, 4, 4};
            b.scene().lights.push_back(light);
        }
        return b.build();
    };
    for (Scene scene : {spots(), ranges(), column()}) {
        const test::ChartedScene charted(std::move(scene), 5, context);
        const TwoRuns plain(gather_direct(charted, false, 1), gather_direct(charted, false, 2)),
            learned(gather_direct(charted, true, 3), gather_direct(charted, true, 4));
        ASSERT_GT(plain.mean, 0.0);
        // Light that is lost is no noise, and light that one sample in millions finds is a lot.
        EXPECT_NEAR(learned.mean, plain.mean, 4.0 * std::sqrt(plain.noise + learned.noise) + 1e-5 * plain.mean);
        // The rims, a tenth of the texels or so, have a sixth of the share that is due to them: 15 % of error after 256
        // samples, 0.15 * sqrt(0.1) over all texels.
        const auto texels = static_cast<double>(charted.texels.size());
        EXPECT_LT(std::sqrt(learned.noise / texels), 0.05 * learned.mean / texels);
    }
}

// Bounced light by far outweighs the noise of a small lamp: fewer light samples, the same light.
TEST(LearnedLights, EveryOtherPathIsEnoughWhereLightBounces) {
    Context context(2);
    test::SceneBuilder b;
    b.object("room", b.material({0.8f, 0.8f, 0.8f}), [](Mesh& m) {
        test::add_quad(m, {0, 0, 4}, {4, 0, 0}, {0, 0, -4});
        test::add_quad(m, {0, 3, 0}, {4, 0, 0}, {0, 0, 4});
        test::add_quad(m, {0, 0, 0}, {4, 0, 0}, {0, 3, 0});
        test::add_quad(m, {4, 0, 4}, {-4, 0, 0}, {0, 3, 0});
        test::add_quad(m, {0, 0, 4}, {0, 0, -4}, {0, 3, 0});
        test::add_quad(m, {4, 0, 0}, {0, 0, 4}, {0, 3, 0});
    });
    Light lamp;
    lamp.position = {2, 1.5f, 2};
    lamp.intensity = {2, 2, 2};
    b.scene().lights.push_back(lamp);
    const test::ChartedScene rooms(b.build(), 4, context);
    const auto gather = [&](bool learned, std::uint64_t seed, std::uint64_t& rays) {
        PathOptions path;
        path.bounces = 1;
        path.samples = 256;
        path.lights_learned = learned;
        path.seed = seed;
        const std::uint64_t before = rooms.traced.transport.tracer.statistics().rays;
        RadianceSums sums = rooms.gather(path);
        rays = rooms.traced.transport.tracer.statistics().rays - before;
        return sums;
    };
    std::uint64_t rays_plain = 0, rays_learned = 0;
    const RadianceSums plain = gather(false, 1, rays_plain), other = gather(false, 2, rays_plain),
                       learned = gather(true, 3, rays_learned);
    // Four rays a path, two of them to the lamp, the first of these for every other path.
    EXPECT_NEAR(static_cast<double>(rays_learned) / static_cast<double>(rays_plain), 3.5 / 4.0, 0.02);
    double mean = 0.0, mean_learned = 0.0, noise = 0.0;
    for (std::size_t i = 0; i < rooms.texels.size(); ++i) {
        if (!plain.valid(i) || !other.valid(i) || !learned.valid(i)) continue;
        const double a = test::total_irradiance(plain, i).y, b = test::total_irradiance(other, i).y;
        mean += 0.5 * (a + b);
        noise += (a - b) * (a - b);
        mean_learned += test::total_irradiance(learned, i).y;
    }
    // The difference of the sums of one run and the mean of two has 1.5 times the variance of one run, noise / 2; the
    // learned run may have half as much again.
    EXPECT_NEAR(mean_learned, mean, 4.0 * std::sqrt(noise));
}

}  // namespace
}  // namespace lumel
