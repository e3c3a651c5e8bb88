// Known answers as in sh_test.cpp: from an independent double-precision program; 3e-6 of the largest term covers the
// float roundings (std::pow included).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "encode/irradiance.h"
#include "encode/l1.h"
#include "encode/units.h"
#include "sh/zonal.h"

namespace lumel {
namespace {

constexpr float kTolerance = 3e-6f;
constexpr Vec3 kN7{2.0f / 7, 3.0f / 7, 6.0f / 7};

// R0 = 1.3, R1 = (.3, .2, .4) as radiance SH.
constexpr std::array<float, 4> kInput{4.60838001235f, -1.22799204954f, 2.45598409907f, -1.8419880743f};

RadianceSh<Vec3, 4> grey(const std::array<float, 4>& l) {
    RadianceSh<Vec3, 4> out;
    for (std::size_t i = 0; i < 4; ++i) out.c[i] = Vec3{1, 1, 1} * l[i];
    return out;
}

TEST(L1, StoresMeanRadianceAndNormalisedDirection) {
    const L1Texel texel = encode_l1(grey(kInput));
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(texel.l0[c], 1.3, kTolerance);
        EXPECT_NEAR(texel.l1n[c].x, .3 / 1.3, kTolerance);
        EXPECT_NEAR(texel.l1n[c].y, .2 / 1.3, kTolerance);
        EXPECT_NEAR(texel.l1n[c].z, .4 / 1.3, kTolerance);
    }
}

TEST(L1, LinearKnownAnswers) {
    const L1Texel texel = encode_l1(grey(kInput));
    EXPECT_NEAR(evaluate_l1_linear(texel, kN7).x, 2.32857142857, kTolerance);
    EXPECT_NEAR(evaluate_l1_linear(texel, -kN7).y, 0.271428571429, kTolerance);
}

TEST(L1, HazelKnownAnswers) {
    const L1Texel texel = encode_l1(grey(kInput));
    EXPECT_NEAR(evaluate_l1_hazel(texel, kN7).x, 2.60472031178, kTolerance);
    EXPECT_NEAR(evaluate_l1_hazel(texel, -kN7).y, 0.540528873337, kTolerance);
}

TEST(L1, LinearAgreesWithTheIrradianceOfTheSameBands) {
    const auto irradiance = convolve_cosine(grey(kInput));
    const L1Texel texel = encode_l1(grey(kInput));
    for (const Vec3 n : {kN7, Vec3{0, 1, 0}, Vec3{-0.6f, 0, 0.8f}})
        EXPECT_NEAR(evaluate_l1_linear(texel, n).z, evaluate(irradiance, n).z, kTolerance);
}

// A texel of constant radiance 1 over its hemisphere: |l1n| = 1/2; linear is exact at the normal, Hazel 7/6.
TEST(L1, UniformHemisphere) {
    const L1Texel texel = encode_l1(linear_part(hemisphere_light(Vec3{1, 1, 1}, kN7)));
    EXPECT_NEAR(length(texel.l1n[0]), 0.5, kTolerance);
    EXPECT_NEAR(evaluate_l1_linear(texel, kN7).x, 1.0, kTolerance);
    EXPECT_NEAR(evaluate_l1_hazel(texel, kN7).x, 1.16666666667, kTolerance);
}

// Single light, r = 1: I = 4 q^3 where the truth is 4 max(cos, 0) (in units of R0).
TEST(L1, HazelOfASingleLight) {
    const L1Texel texel = encode_l1(linear_part(directional_light(Vec3{4, 4, 4}, Vec3{0, 0, 1})));
    for (const float z : {1.0f, 0.5f, 0.0f, -0.5f}) {
        const float q = (1 + z) / 2;
        const Vec3 n{std::sqrt(1 - z * z), 0, z};
        EXPECT_NEAR(evaluate_l1_hazel(texel, n).x, 4 * q * q * q, 4 * kTolerance) << z;
    }
    EXPECT_NEAR(evaluate_l1_hazel(texel, Vec3{0, 0, -1}).x, 0.0, kTolerance);
}

TEST(L1, HazelKeepsTheEnergyAndIsNeverNegative) {
    const L1Texel texel = encode_l1(grey(kInput));
    double sum = 0;
    constexpr int kSteps = 4000;
    const Vec3 axis = normalize(Vec3{.3f, .2f, .4f}), side = normalize(cross(axis, Vec3{1, 0, 0}));
    for (int i = 0; i < kSteps; ++i) {
        const float z = -1 + 2 * (float(i) + 0.5f) / kSteps;
        const float value = evaluate_l1_hazel(texel, axis * z + side * std::sqrt(1 - z * z)).x;
        ASSERT_GE(value, 0.0f);
        sum += value;
    }
    EXPECT_NEAR(sum / kSteps, 1.3, 1e-5);  // midpoint rule: 1/(24 * 4000^2) of the second derivative, plus float sums
}

TEST(L1, BlackAndSingleColour) {
    EXPECT_EQ(evaluate_l1_hazel(encode_l1({}), kN7), Vec3{});
    EXPECT_EQ(evaluate_l1_linear(encode_l1({}), kN7), Vec3{});
    RadianceSh<Vec3, 4> red;
    for (std::size_t i = 0; i < 4; ++i) red.c[i] = Vec3{kInput[i], 0, 0};
    const Vec3 value = evaluate_l1_hazel(encode_l1(red), kN7);
    EXPECT_NEAR(value.x, 2.60472031178, kTolerance);
    EXPECT_EQ(value.y, 0.0f);
    EXPECT_EQ(value.z, 0.0f);
}

TEST(Units, PiIsAppliedOnce) {
    EXPECT_FLOAT_EQ(to_file_unit(2.0f, LightUnit::e), 6.2831853f);
    EXPECT_EQ(to_file_unit(2.0f, LightUnit::e_over_pi), 2.0f);
    EXPECT_FLOAT_EQ(from_file_unit(to_file_unit(0.37f, LightUnit::e), LightUnit::e), 0.37f);
    EXPECT_STREQ(unit_name(LightUnit::e), "E");
    EXPECT_STREQ(unit_name(LightUnit::e_over_pi), "E/pi");
}

TEST(Layers, IncludePicksWhatIsSummed) {
    constexpr std::array<Vec3, 3> layers{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const auto value = [&](std::size_t i) { return layers[i]; };
    EXPECT_EQ(sum_layers(layer_weights({}), value), (Vec3{1, 1, 1}));
    EXPECT_EQ(sum_layers(layer_weights({.direct = false}), value), (Vec3{0, 1, 1}));
    EXPECT_EQ(sum_layers(layer_weights({.sky = false, .indirect = false}), value), (Vec3{1, 0, 0}));
    EXPECT_EQ(sum_layers(LayerWeights{2, 0, 3}, value), (Vec3{2, 0, 3}));
}

TEST(Layers, AnExcludedLayerCannotLeak) {
    const float inf = std::numeric_limits<float>::infinity();
    const std::array<Vec3, 3> layers{Vec3{inf, inf, inf}, Vec3{1, 1, 1}, Vec3{2, 2, 2}};
    EXPECT_EQ(sum_layers(layer_weights({.direct = false}), [&](std::size_t i) { return layers[i]; }), (Vec3{3, 3, 3}));
}

TEST(Layers, ShSumIsPerCoefficient) {
    const auto up = hemisphere_light(Vec3{1, 1, 1}, Vec3{0, 1, 0}),
               down = hemisphere_light(Vec3{1, 1, 1}, Vec3{0, -1, 0});
    const std::array<std::array<Vec3, 9>, 3> layers{up.c, down.c, up.c};
    const auto sum = sum_sh_layers(layer_weights({.indirect = false}),
                                   [&](std::size_t i) -> const std::array<Vec3, 9>& { return layers[i]; });
    // Two hemispheres make the full sphere of radiance 1: I = 1 for every normal.
    for (const Vec3 n : {kN7, Vec3{0, -1, 0}}) EXPECT_NEAR(irradiance_from_sh(sum, n).x, 1.0, kTolerance);
}

}  // namespace
}  // namespace lumel
