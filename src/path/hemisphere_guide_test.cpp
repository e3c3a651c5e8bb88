#include "path/hemisphere_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/sampler.h"
#include "support/charted_scene.h"

namespace lumel {
namespace {

using Bins = std::array<float, HemisphereGuide::kBins>;

Bins one_bright_spot() {
    Bins bins{};
    bins[3 * HemisphereGuide::kColumns + 5] = 1.0f;
    bins[3 * HemisphereGuide::kColumns + 6] = 2.0f;
    return bins;
}

TEST(HemisphereGuide, PointsAreDrawnByTheDensityTheyState) {
    const HemisphereGuide guide(one_bright_spot());
    constexpr std::uint32_t kPoints = 1u << 16;
    Bins drawn{};
    double area = 0.0;  // of the unit square, by importance: sum of 1 / density
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const HemisphereGuide::Draw draw = guide.draw(Sampler(7, i).pair(0));
        ASSERT_TRUE(draw.point.x >= 0.0f && draw.point.x < 1.0f && draw.point.y >= 0.0f && draw.point.y < 1.0f);
        ASSERT_EQ(draw.density, guide.density(draw.point)) << i;
        ASSERT_GE(draw.density, HemisphereGuide::kFloor);
        drawn[HemisphereGuide::bin_of(draw.point)] += 1.0f;
        area += 1.0 / static_cast<double>(draw.density);
    }
    EXPECT_NEAR(area / kPoints, 1.0, 1e-3);
    for (std::size_t bin = 0; bin < drawn.size(); ++bin) {
        const Vec2 middle{(static_cast<float>(bin / HemisphereGuide::kColumns) + 0.5f) / HemisphereGuide::kRows,
                          (static_cast<float>(bin % HemisphereGuide::kColumns) + 0.5f) / HemisphereGuide::kColumns};
        const float expected = guide.density(middle) * kPoints / static_cast<float>(HemisphereGuide::kBins);
        // Points of a (0,2)-sequence: independent ones would scatter by the root of this.
        EXPECT_NEAR(drawn[bin], expected, 2.0f * std::sqrt(expected)) << bin;
    }
}

TEST(HemisphereGuide, TheFloorAndTheWantedShareTheDensity) {
    const HemisphereGuide guide(one_bright_spot());
    const auto at = [&](float row, float column) {
        return guide.density({(row + 0.5f) / HemisphereGuide::kRows, (column + 0.5f) / HemisphereGuide::kColumns});
    };
    const float wanted = (1.0f - HemisphereGuide::kFloor) * HemisphereGuide::kBins;
    EXPECT_FLOAT_EQ(at(0, 0), HemisphereGuide::kFloor);
    EXPECT_FLOAT_EQ(at(3, 5), HemisphereGuide::kFloor + wanted / 3.0f);
    EXPECT_FLOAT_EQ(at(3, 6), HemisphereGuide::kFloor + wanted * 2.0f / 3.0f);
}

// Radiance by direction, seen by n paths.
template <class Radiance>
GuideStatistics statistics_of(std::uint32_t n, Radiance&& radiance) {
    GuideStatistics out;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec2 point = Sampler(3, i).pair(0);
        out.add(i & 1u, point, 1.0f, radiance(point));
    }
    return out;
}

TEST(GuideStatistics, LearnsABrightWindow) {
    const auto window = [](Vec2 p) { return p.x > 0.4f && p.x < 0.5f && p.y > 0.2f && p.y < 0.3f ? 10.0f : 0.1f; };
    EXPECT_FALSE(statistics_of(500, window).learn().has_value()) << "too few paths";
    const auto guide = statistics_of(4096, window).learn();
    ASSERT_TRUE(guide.has_value());
    EXPECT_GT(guide->density({0.45f, 0.25f}), 10.0f);
    EXPECT_LT(guide->density({0.8f, 0.7f}), 0.7f);
}

TEST(GuideStatistics, LearnsNothingOfEvenLightOrOfAccidents) {
    EXPECT_FALSE(statistics_of(4096, [](Vec2) { return 1.0f; }).learn().has_value());
    EXPECT_FALSE(statistics_of(4096, [](Vec2) { return 0.0f; }).learn().has_value());
    // One path in a thousand, anywhere, is very bright: what one half has seen tells the other nothing.
    std::mt19937 random(1);
    EXPECT_FALSE(statistics_of(4096, [&](Vec2) { return random() % 1024 == 0 ? 100.0f : 1.0f; }).learn().has_value());
}

// Guided paths state their densities: the window is seen as large as it is.
TEST(GuideStatistics, GuidedPathsTeachTheSameAsOthers) {
    const auto window = [](Vec2 p) { return p.x > 0.4f && p.x < 0.6f && p.y > 0.2f && p.y < 0.4f ? 10.0f : 1.0f; };
    const HemisphereGuide before(one_bright_spot());
    GuideStatistics guided;
    for (std::uint32_t i = 0; i < (1u << 16); ++i) {
        const HemisphereGuide::Draw draw = before.draw(Sampler(3, i).pair(0));
        guided.add(i & 1u, draw.point, draw.density, window(draw.point));
    }
    const auto a = guided.learn(), b = statistics_of(1u << 16, window).learn();
    ASSERT_TRUE(a.has_value() && b.has_value());
    for (const Vec2 p : {Vec2{0.5f, 0.3f}, Vec2{0.2f, 0.2f}, Vec2{0.9f, 0.9f}})
        EXPECT_NEAR(a->density(p) / b->density(p), 1.0f, 0.05f);
}

// A room that light enters by a hole in the ceiling. A wall of one side stands in it: the paths of texels behind that
// meet its back are black.
Scene room_below_a_hole() {
    test::SceneBuilder b;
    const auto white = b.material({0.5f, 0.5f, 0.5f});
    b.object("room", white, [](Mesh& m) {
        test::add_quad(m, {0, 0, 4}, {4, 0, 0}, {0, 0, -4});  // floor
        test::add_quad(m, {0, 0, 0}, {4, 0, 0}, {0, 3, 0});   // walls
        test::add_quad(m, {4, 0, 4}, {-4, 0, 0}, {0, 3, 0});
        test::add_quad(m, {0, 0, 4}, {0, 0, -4}, {0, 3, 0});
        test::add_quad(m, {4, 0, 0}, {0, 0, 4}, {0, 3, 0});
        test::add_quad(m, {0, 3, 0}, {4, 0, 0}, {0, 0, 1.8f});  // ceiling around the hole
        test::add_quad(m, {0, 3, 2.2f}, {4, 0, 0}, {0, 0, 1.8f});
        test::add_quad(m, {0, 3, 1.8f}, {1.8f, 0, 0}, {0, 0, 0.4f});
        test::add_quad(m, {2.2f, 3, 1.8f}, {1.8f, 0, 0}, {0, 0, 0.4f});
        test::add_quad(m, {3, 0, 1}, {0, 0, 2}, {0, 1, 0});  // seen from its front by texels at x > 3 only
    });
    b.scene().sky.color = {1, 1, 1};
    return b.build();
}

TEST(GuidedTexels, HaveTheSameMeanAndLessNoise) {
    Context context(2);
    const test::ChartedScene room(room_below_a_hole(), 8, context);
    const auto gather = [&](bool guided, std::uint64_t seed) {
        PathOptions path;
        path.bounces = 1;
        path.samples = 256;
        path.guided = guided;
        path.seed = seed;
        return room.gather(path);
    };
    const std::array plain{gather(false, 1), gather(false, 2)}, guided{gather(true, 3), gather(true, 4)};

    struct Totals {
        double mean = 0.0, noise = 0.0, stated = 0.0, counted = 0.0;
    };
    const auto totals = [&](const std::array<RadianceSums, 2>& runs, std::size_t i) {
        const float a = test::total_irradiance(runs[0], i).y, b = test::total_irradiance(runs[1], i).y;
        return Totals{static_cast<double>(a + b) / 2, static_cast<double>((a - b) * (a - b)) / 4,
                      static_cast<double>(runs[0].variance[i].y + runs[1].variance[i].y) / 4,
                      static_cast<double>(runs[0].open[i] + runs[1].open[i]) / 512.0};
    };
    Totals p, g;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < room.texels.size(); ++i) {
        if (!plain[0].valid(i) || !plain[1].valid(i) || !guided[0].valid(i) || !guided[1].valid(i)) continue;
        for (auto [sum, of] : {std::pair{&p, totals(plain, i)}, {&g, totals(guided, i)}}) {
            sum->mean += of.mean;
            sum->noise += of.noise;
            sum->stated += of.stated;
            sum->counted += of.counted;
        }
        ++compared;
    }
    ASSERT_GT(compared, 3000u);
    ASSERT_LT(p.counted, 0.995 * static_cast<double>(compared)) << "no path meets a back: half of this test is missing";
    EXPECT_LT(g.noise, 0.75 * p.noise);
    // The stated variance takes samples as independent: more than there is.
    EXPECT_LT(std::fabs(g.mean - p.mean), 4.0 * std::sqrt(p.stated + g.stated));
    EXPECT_NEAR(g.counted / p.counted, 1.0, 0.002) << "share of paths that count";
}

}  // namespace
}  // namespace lumel
