#include "path/light_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "math/discrete.h"
#include "support/charted_scene.h"
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
    std::array<Receiver, 1> receivers{Receiver{{0, 0, 0}, {0, 1, 0}, nullptr}};
    LightStatistics statistics;

    explicit Row(const std::vector<Vec3>& intensities)
        : traced(row_of_lights(intensities), context), lights(traced.transport.lights) {
        statistics.begin(lights, receivers);
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
    for (std::size_t g = 0; g < 3; ++g) total += row.lights.importance_of(g, row.receivers[0]);
    for (std::size_t g = 0; g < 3; ++g)
        EXPECT_NEAR(chances[g], row.lights.importance_of(g, row.receivers[0]) / total, 1e-6) << g;
}

TEST(LightStatistics, HaveNothingToSayOfOneLightOrOfNone) {
    Row one({{1, 1, 1}});
    EXPECT_FALSE(one.statistics.table(0));
    LightStatistics never;
    EXPECT_FALSE(never.table(0));
    // All lights are behind the receiver.
    Row below({{1, 1, 1}, {1, 1, 1}});
    below.receivers[0].normal = {0, -1, 0};
    below.statistics.begin(below.lights, below.receivers);
    EXPECT_FALSE(below.statistics.table(0));
}

// A light that samples never reach keeps a tenth of what it had; what it leaves goes to the others.
TEST(LightStatistics, BlockedLightsLoseTheirShare) {
    Row row({{3, 3, 3}, {3, 3, 3}, {3, 3, 3}, {3, 3, 3}});
    const std::vector<double> before = row.chances();
    for (int i = 0; i < 4000; ++i) {
        const auto group = static_cast<std::uint32_t>(i % 4);
        row.statistics.add(0, group, group == 2 ? 0.0f : static_cast<float>(0.5 / before[group]));
    }
    const std::vector<double> after = row.chances();
    EXPECT_NEAR(after[2], 0.1 * before[2], 0.3 * before[2]);
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

// Two rooms with a hundred lamps each, and a wall between them.
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
    // Those of the other room are near, too, and cannot be seen.
    for (int i = 0; i < 100; ++i)
        for (const float x : {0.4f, 4.4f}) {
            Light light;
            light.shape = LightShape::rectangle;
            light.position = {x + 0.35f * static_cast<float>(i % 10), 2.9f, 0.4f * static_cast<float>(i / 10) + 0.2f};
            light.direction = {0, -1, 0};
            light.half_u = {0.1f, 0, 0};
            light.half_v = {0, 0, 0.1f};
            light.intensity = {2, 2, 2};
            b.scene().lights.push_back(light);
        }
    return b.build();
}

TEST(LearnedLights, HaveTheSameMeanAndLessNoise) {
    Context context(2);
    const test::ChartedScene rooms(two_rooms(), 3, context);
    const auto gather = [&](bool learned, std::uint64_t seed) {
        PathOptions path;
        path.bounces = 0;
        path.samples = 256;
        path.lights_learned = learned;
        path.seed = seed;
        return rooms.gather(path);
    };
    const std::array plain{gather(false, 1), gather(false, 2)}, learned{gather(true, 3), gather(true, 4)};
    double mean[2] = {0, 0}, noise[2] = {0, 0};
    for (std::size_t i = 0; i < rooms.texels.size(); ++i)
        for (const std::size_t which : {0u, 1u}) {
            const auto& runs = which == 0 ? plain : learned;
            if (!plain[0].valid(i) || !plain[1].valid(i)) continue;
            const double a = test::total_irradiance(runs[0], i).y, b = test::total_irradiance(runs[1], i).y;
            mean[which] += 0.5 * (a + b);
            noise[which] += 0.25 * (a - b) * (a - b);
        }
    ASSERT_GT(mean[0], 0.0);
    EXPECT_LT(noise[1], 0.6 * noise[0]);
    // Four deviations of the sums, by the noise itself.
    EXPECT_NEAR(mean[1], mean[0], 4.0 * std::sqrt(noise[0] + noise[1]));
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
