// Known answers from an independent double-precision program (symbolic identities, spectral quadrature); tolerances are
// a few roundings of float, 6e-8 of the largest term each.
#include "sh/hemisphere.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumel {
namespace {

constexpr float kTolerance = 2e-6f;
constexpr Vec3 kN7{2.0f / 7, 3.0f / 7, 6.0f / 7};
constexpr Rotation kFrame7{Vec3{6.0f / 7, 2.0f / 7, -3.0f / 7}, Vec3{-3.0f / 7, 6.0f / 7, -2.0f / 7}, kN7};
constexpr RadianceSh<float, 9> kLk{{3.0f, -.4f, .9f, -.6f, .25f, -.3f, .35f, -.15f, .2f}};

// Midpoint rule over directions with z in [low, 1]: exact in phi for what is tested, O(1/n^2) in z.
template <class F>
void for_cap(double low, F&& f) {
    constexpr int kZ = 1000, kPhi = 16;
    for (int i = 0; i < kZ; ++i) {
        const double z = low + (1 - low) * (i + 0.5) / kZ, r = std::sqrt(1 - z * z);
        for (int j = 0; j < kPhi; ++j) {
            const double phi = 2 * M_PI * (j + 0.5) / kPhi;
            f(Vec3{float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)}, (1 - low) * 2 * M_PI / (kZ * kPhi));
        }
    }
}

TEST(Gram, HemisphereKnownAnswers) {
    EXPECT_NEAR(kHemisphereGram.m02, 0.433012701892, kTolerance);
    EXPECT_NEAR(kHemisphereGram.m15, 0.419262745781, kTolerance);
    EXPECT_NEAR(kHemisphereGram.m26, 0.242061459138, kTolerance);
    EXPECT_EQ(kHemisphereGram.m06, 0.0f);
    for (const float diagonal : {kHemisphereGram.m00, kHemisphereGram.m11, kHemisphereGram.m22, kHemisphereGram.m44,
                                 kHemisphereGram.m55, kHemisphereGram.m66})
        EXPECT_EQ(diagonal, 0.5f);
}

TEST(Gram, ConeKnownAnswers) {
    constexpr ZonalMatrix g = cone_gram(0.5);
    EXPECT_NEAR(g.m00, 0.25, kTolerance);
    EXPECT_NEAR(g.m02, 0.324759526419, kTolerance);
    EXPECT_NEAR(g.m06, 0.209631372891, kTolerance);
    EXPECT_NEAR(g.m11, 0.15625, kTolerance);
    EXPECT_NEAR(g.m15, 0.235835294502, kTolerance);
    EXPECT_NEAR(g.m22, 0.4375, kTolerance);
    EXPECT_NEAR(g.m26, 0.317705665119, kTolerance);
    EXPECT_NEAR(g.m44, 0.103515625, kTolerance);
    EXPECT_NEAR(g.m55, 0.3671875, kTolerance);
    EXPECT_NEAR(g.m66, 0.30859375, kTolerance);
}

// All 81 entries, those that multiply() takes for zero among them, against integration.
TEST(Gram, IsTheIntegralOfProducts) {
    for (const double c : {0.0, 0.3, 0.8, -0.5, -1.0}) {
        double sum[9][9] = {};
        for_cap(c, [&](Vec3 w, double dw) {
            const ShBasis y = sh_basis(w);
            for (int i = 0; i < 9; ++i)
                for (int j = 0; j < 9; ++j) sum[i][j] += double(y[i]) * y[j] * dw;
        });
        for (std::size_t j = 0; j < 9; ++j) {
            std::array<float, 9> unit{};
            unit[j] = 1;
            const auto column = multiply(cone_gram(c), unit);
            // The midpoint rule leaves (2/1000)^2 / 24 times a second derivative of at most some 20.
            for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(column[i], sum[i][j], 5e-6) << c << " " << i << " " << j;
        }
    }
}

TEST(HemisphereMultiply, TangentPartOfBandTwo) {
    const auto p2 = tangent_quadratic(kLk, kN7);
    EXPECT_NEAR(p2[0], 0.0914621589682, kTolerance);
    EXPECT_NEAR(p2[1], 0.0224052100485, kTolerance);
    EXPECT_NEAR(p2[2], -0.0699776083069, kTolerance);
}

TEST(HemisphereMultiply, LinearKnownAnswers) {
    constexpr std::array<double, 4> expected{1.98249986782, -0.770313145605, 1.6767133129, -0.735112218541};
    const auto l = multiply_hemisphere_linear(kLk, kN7);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(l.c[i], expected[i], 2 * kTolerance) << i;
}

// In the tangent frame it is the linear part of the product with the Gram matrix.
TEST(HemisphereMultiply, LinearIsTheGramProductOfTheRotatedFrame) {
    const auto local = rotate(multiply_hemisphere_linear(kLk, kN7), kFrame7);
    const auto product = multiply(kHemisphereGram, rotate(kLk, kFrame7).c);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(local.c[i], product[i], 2 * kTolerance) << i;
}

TEST(Hlsh, KnownAnswersOfHemisphereAndCone) {
    struct Answer {
        float c;
        double ambient, x, y, z, iz;
    };
    for (const Answer& a :
         {Answer{0.0f, 0.486215100561, 0.299901559531, 0.310657532699, 0.680334026542, 1.28818365433},
          Answer{0.5f, 0.184233108246, 0.278415650284, 0.357147658968, 0.745577641098, 1.05591026883}}) {
        const auto h = multiply_cone(kLk, kN7, a.c);
        EXPECT_NEAR(h.ambient, a.ambient, kTolerance);
        EXPECT_NEAR(h.linear.x, a.x, kTolerance);
        EXPECT_NEAR(h.linear.y, a.y, kTolerance);
        EXPECT_NEAR(h.linear.z, a.z, kTolerance);
        EXPECT_NEAR(h.iz, a.iz, kTolerance);
    }
}

TEST(Hlsh, AClosedConeIsDark) {
    const auto h = multiply_cone(kLk, kN7, 1.0f);
    // Powers of c cancel: terms of some 2000/4096 leave their roundings.
    EXPECT_NEAR(h.iz, 0.0, 2e-6);
    EXPECT_NEAR(h.ambient, 0.0, 2e-6);
    EXPECT_NEAR(h.linear.x, 0.0, 2e-6);
}

TEST(ConeCosine, KnownAnswerAndClamp) {
    EXPECT_NEAR(cone_cosine(0.3f, 0.8f), 0.790569415042, kTolerance);
    EXPECT_EQ(cone_cosine(0.8f, 0.8f), 0.0f);
    EXPECT_EQ(cone_cosine(0.5f, 0.2f), 0.0f);
}

// Uniform light and single directions, whose irradiance is known: K's polynomial is the nearest quadratic one, so no
// other quadratic (the truncated cosine's among them) may come closer in the mean over directions of light.
TEST(IrradianceFit, IsExactForUniformLight) {
    const auto fit = fit_irradiance(hemisphere_light(1.0f, Vec3{0, 0, 1}));
    // Terms of 3.5 cancel to 1.
    for (const Vec3 n : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6f, 0, 0.8f}})
        EXPECT_NEAR(evaluate(fit, n), (1 + n.z) / 2, 5 * kTolerance);
}

double mean_squared_error(bool fitted) {
    double sum = 0, weight = 0;
    for (int i = 0; i < 12; ++i) {
        const float z = (float(i) + 0.5f) / 12, r = std::sqrt(1 - z * z);
        const Vec3 d{r, 0, z};
        const auto light = directional_light(1.0f, d);
        const auto i_sh = fitted ? fit_irradiance(light) : convolve_cosine(light);
        for_cap(0.0, [&](Vec3 n, double dw) {
            const double e = evaluate(i_sh, n) - std::max(dot(n, d), 0.0f);
            sum += e * e * dw;
            weight += dw;
        });
    }
    return sum / weight;
}

TEST(IrradianceFit, IsCloserThanTheBandsOfTheSphere) {
    const double bands = mean_squared_error(false), fit = mean_squared_error(true);
    EXPECT_LT(fit, 0.95 * bands);  // 0.00119 and 0.00127
}

}  // namespace
}  // namespace lumel
