// Every warp: its samples follow its density (chi-squared), its density integrates to 1, its inverse undoes it.
#include "math/warp.h"

#include <gtest/gtest.h>

#include "support/statistics.h"

namespace lumel {
namespace {

// Chi-squared tests in this file; each has this share of a false-alarm rate of 1e-4 for all of them.
const double kSignificance = test::sidak(1e-4, 10);

TEST(GatherHemisphere, SamplesFollowTheDensity) {
    test::DirectionTest chi2;
    chi2.significance = kSignificance;
    EXPECT_TRUE(test::directions_agree(
        chi2, [](test::Random& r) { return GatherHemisphere::sample(r.pair()); },
        [](Vec3 d) { return GatherHemisphere::pdf(d.z); }));
}

TEST(GatherHemisphere, TheTestAboveNoticesAnotherDensity) {
    test::DirectionTest chi2;
    chi2.significance = kSignificance;
    EXPECT_FALSE(test::directions_agree(
        chi2, [](test::Random& r) { return CosineHemisphere::sample(r.pair()); },
        [](Vec3 d) { return GatherHemisphere::pdf(d.z); }));
}

TEST(GatherHemisphere, TheInverseUndoesIt) {
    test::Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const Vec2 u = random.pair(), back = GatherHemisphere::inverse(GatherHemisphere::sample(u));
        ASSERT_NEAR(back.x, u.x, 2e-6f);
        // The azimuth is ill conditioned near the pole (u.x = 1), and round.
        const float turn = std::fabs(back.y - u.y);
        ASSERT_LE(std::min(turn, 1.0f - turn) * std::sqrt(1.0f - u.x), 2e-6f);
    }
}

TEST(CosineHemisphere, SamplesFollowTheDensity) {
    test::DirectionTest chi2;
    chi2.significance = kSignificance;
    EXPECT_TRUE(test::directions_agree(
        chi2, [](test::Random& r) { return CosineHemisphere::sample(r.pair()); },
        [](Vec3 d) { return CosineHemisphere::pdf(d.z); }));
}

TEST(UniformCone, SamplesFollowTheDensityFromTheSunToTheHemisphere) {
    for (const double half_angle : {0.00465, 0.3, 1.5707963}) {
        test::DirectionTest chi2;
        const double one_minus_cos = 2 * std::pow(std::sin(half_angle / 2), 2);
        chi2.min_cosine = 1 - 1.25 * one_minus_cos;  // the cone ends at a cell's edge: 4/5 of 20 rings
        chi2.rings = 20;
        chi2.significance = kSignificance;
        const auto h = static_cast<float>(one_minus_cos);
        EXPECT_TRUE(test::directions_agree(
            chi2, [h](test::Random& r) { return UniformCone::sample(r.pair(), h); },
            [&](Vec3 d) {
                const double x = d.x, y = d.y, h_of_d = (x * x + y * y) / (1 + std::sqrt(1 - x * x - y * y));
                return d.z > -0.5f && h_of_d <= one_minus_cos && (d.z >= 0) ? double{UniformCone::pdf(h)} : 0.0;
            }))
            << half_angle;
    }
}

TEST(ConcentricDisc, IsUniform) {
    // Rings of equal area by sectors of equal angle.
    constexpr int kRings = 16, kSectors = 32, kSamples = 200000;
    std::vector<double> observed(kRings * kSectors),
        expected(kRings * kSectors, double(kSamples) / (kRings * kSectors));
    test::Random random(1);
    for (int i = 0; i < kSamples; ++i) {
        const Vec2 p = ConcentricDisc::sample(random.pair());
        const double r2 = double{p.x} * p.x + double{p.y} * p.y;
        ASSERT_LE(r2, 1.000001);
        const int ring = std::min(kRings - 1, static_cast<int>(r2 * kRings));
        const int sector = static_cast<int>((std::atan2(p.y, p.x) / 6.283185307179586 + 1.0) * kSectors) % kSectors;
        observed[static_cast<std::size_t>(ring * kSectors + sector)] += 1;
    }
    EXPECT_TRUE(test::counts_agree(observed, expected, kSignificance));
}

TEST(ConcentricDisc, MapsTheCentreToTheCentre) { EXPECT_EQ(ConcentricDisc::sample({0.5f, 0.5f}), Vec2{}); }

TEST(UniformTriangle, IsUniform) {
    // 16 x 16 small triangles: two per square of the (b1, b2) grid.
    constexpr int kGrid = 16, kSamples = 200000;
    std::vector<double> observed(2 * kGrid * kGrid), expected(2 * kGrid * kGrid);
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; i + j < kGrid; ++j) {
            expected[static_cast<std::size_t>(2 * (i * kGrid + j))] = double(kSamples) / (kGrid * kGrid);
            if (i + j + 1 < kGrid)
                expected[static_cast<std::size_t>(2 * (i * kGrid + j) + 1)] = double(kSamples) / (kGrid * kGrid);
        }
    test::Random random(1);
    for (int k = 0; k < kSamples; ++k) {
        const Vec2 b = UniformTriangle::sample(random.pair());
        ASSERT_GE(b.x, 0.0f);
        ASSERT_GE(b.y, 0.0f);
        ASSERT_LE(b.x + b.y, 1.0f);
        const double x = double{b.x} * kGrid, y = double{b.y} * kGrid;
        const int i = static_cast<int>(x), j = static_cast<int>(y);
        const bool upper = (x - i) + (y - j) > 1.0;
        observed[static_cast<std::size_t>(2 * (i * kGrid + j) + upper)] += 1;
    }
    EXPECT_TRUE(test::counts_agree(observed, expected, kSignificance));
}

TEST(Hemispheres, TheInverseUndoesTheSample) {
    test::Random random(5);
    for (int i = 0; i < 10000; ++i) {
        const Vec2 u = random.pair();
        // z and z^2 carry two or three roundings of values up to 2.
        ASSERT_NEAR(GatherHemisphere::inverse_u(GatherHemisphere::sample(u).z), u.x, 4e-7);
        ASSERT_NEAR(CosineHemisphere::inverse_u(CosineHemisphere::sample(u).z), u.x, 2e-7);
    }
}

TEST(Hemispheres, SamplesAreUnitAndNeverBelowTheHorizon) {
    for (const float u : {0.0f, 0.25f, 0x1.fffffep-1f})
        for (const float v : {0.0f, 0.125f, 0.5f, 0x1.fffffep-1f}) {
            for (const Vec3 d : {GatherHemisphere::sample({u, v}), CosineHemisphere::sample({u, v})}) {
                EXPECT_NEAR(length(d), 1.0, 3e-7);
                EXPECT_GE(d.z, 0.0f);
            }
        }
}

}  // namespace
}  // namespace lumel
