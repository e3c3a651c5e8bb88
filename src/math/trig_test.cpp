#include "math/trig.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/statistics.h"

namespace lumel {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

TEST(Trig, SincosTurnIsWithinItsStatedErrorAnywhere) {
    test::Random random(1);
    double worst = 0;
    for (int i = 0; i < 1000000; ++i) {
        const float range = i % 2 == 0 ? 1.0f : 4194304.0f;  // the stated domain
        const float u = range * (2.0f * random.unit() - 1.0f);
        const SinCos sc = sincos_turn(u);
        const double turn = u - std::floor(static_cast<double>(u));
        worst = std::max(worst, std::fabs(sc.sine - std::sin(2 * kPiDouble * turn)));
        worst = std::max(worst, std::fabs(sc.cosine - std::cos(2 * kPiDouble * turn)));
    }
    EXPECT_LT(worst, 1e-7);
}

TEST(Trig, SincosTurnIsExactAtTheQuarters) {
    for (int i = -8; i <= 8; ++i) {
        const SinCos sc = sincos_turn(0.25f * static_cast<float>(i));
        const int q = i & 3;
        EXPECT_EQ(sc.sine, q == 1 ? 1.0f : (q == 3 ? -1.0f : 0.0f)) << i;
        EXPECT_EQ(sc.cosine, q == 0 ? 1.0f : (q == 2 ? -1.0f : 0.0f)) << i;
    }
}

TEST(Trig, SincosTurnKeepsTheRelativeErrorOfSmallAngles) {
    for (float u = 1e-20f; u < 0.01f; u *= 1.7f)
        EXPECT_NEAR(sincos_turn(u).sine / std::sin(2 * kPiDouble * u), 1.0, 1.2e-7) << u;  // two roundings
}

TEST(Trig, SincosRadiansAgreesWithTheStandardLibrary) {
    test::Random random(2);
    for (int i = 0; i < 200000; ++i) {
        const double angle = (i % 2 == 0 ? 7.0 : 1e6) * (2.0 * random.unit() - 1.0);
        const SinCosDouble sc = sincos_radians(angle);
        const double limit = 1e-15 + 1e-16 * std::fabs(angle);  // as stated
        ASSERT_NEAR(sc.sine, std::sin(angle), limit) << angle;
        ASSERT_NEAR(sc.cosine, std::cos(angle), limit) << angle;
    }
}

TEST(Trig, ArctangentHasRelativeErrorBelow1e15) {
    for (double x = 1e-30; x < 1e30; x *= 1.001) {
        ASSERT_NEAR(arctangent(x) / std::atan(x), 1.0, 1e-15) << x;
        ASSERT_EQ(arctangent(-x), -arctangent(x)) << x;
    }
    EXPECT_EQ(arctangent(0.0), 0.0);
    EXPECT_EQ(arctangent(HUGE_VAL), 0.5 * kPiDouble);
}

TEST(Trig, Arctangent2FindsTheQuadrant) {
    test::Random random(3);
    for (int i = 0; i < 100000; ++i) {
        const double x = random.unit() - 0.5, y = random.unit() - 0.5;
        ASSERT_NEAR(arctangent2(y, x), std::atan2(y, x), 4e-15) << y << " " << x;
    }
    EXPECT_EQ(arctangent2(0.0, 0.0), 0.0);
    EXPECT_EQ(arctangent2(0.0, -2.0), kPiDouble);
    EXPECT_EQ(arctangent2(3.0, 0.0), 0.5 * kPiDouble);
    EXPECT_EQ(arctangent2(-3.0, 0.0), -0.5 * kPiDouble);
}

TEST(Trig, ArcSineAndCosineHoldToTheEndsOfTheirRange) {
    for (int i = -100000; i <= 100000; ++i) {
        const double x = i / 100000.0;
        ASSERT_NEAR(arcsine(x), std::asin(x), 1e-15) << x;
        ASSERT_NEAR(arccosine(x), std::acos(x), 1e-15) << x;
    }
    // Beyond the range by rounding: clamped, not NaN.
    EXPECT_EQ(arcsine(1.0 + 1e-12), 0.5 * kPiDouble);
    EXPECT_EQ(arccosine(1.0 + 1e-12), 0.0);
    EXPECT_EQ(arccosine(-1.0 - 1e-12), kPiDouble);
    EXPECT_NEAR(arccosine(1.0 - 1e-14) / std::acos(1.0 - 1e-14), 1.0, 1e-12);
}

}  // namespace
}  // namespace lumel
