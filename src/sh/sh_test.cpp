// Known answers are computed in double precision by an independent program (symbolic identities and quadrature); our
// float results must agree within 2e-6 of the largest term: some ten roundings of 6e-8.
#include <gtest/gtest.h>

#include <cmath>

#include "sh/coefficients.h"
#include "sh/rotate.h"
#include "sh/zonal.h"

namespace lumel {
namespace {

constexpr float kTolerance = 2e-6f;
constexpr Vec3 kN7{2.0f / 7, 3.0f / 7, 6.0f / 7};
constexpr Rotation kFrame7{Vec3{6.0f / 7, 2.0f / 7, -3.0f / 7}, Vec3{-3.0f / 7, 6.0f / 7, -2.0f / 7}, kN7};
constexpr RadianceSh<float, 9> kLk{{3.0f, -.4f, .9f, -.6f, .25f, -.3f, .35f, -.15f, .2f}};

// Midpoint rule over the sphere in (z, phi): exact in phi for these bands, O(1/n^2) in z.
template <class F>
void for_sphere(F&& f) {
    constexpr int kZ = 2000, kPhi = 16;
    for (int i = 0; i < kZ; ++i) {
        const double z = -1 + 2 * (i + 0.5) / kZ, r = std::sqrt(1 - z * z);
        for (int j = 0; j < kPhi; ++j) {
            const double phi = 2 * M_PI * (j + 0.5) / kPhi;
            f(Vec3{float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)}, 4 * M_PI / (kZ * kPhi));
        }
    }
}

TEST(ShBasis, KnownValues) {
    constexpr std::array<double, 9> expected{0.282094791774,  -0.20940107653,  0.41880215306,
                                             -0.139600717687, 0.133781440481,  -0.401344321442,
                                             0.379757190814,  -0.267562880961, -0.0557422668669};
    const ShBasis y = sh_basis(kN7);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(y[i], expected[i], kTolerance) << i;
}

TEST(ShBasis, OrthonormalOnTheSphere) {
    double gram[9][9] = {};
    for_sphere([&](Vec3 w, double dw) {
        const ShBasis y = sh_basis(w);
        for (int i = 0; i < 9; ++i)
            for (int j = 0; j < 9; ++j) gram[i][j] += double(y[i]) * y[j] * dw;
    });
    // The midpoint rule leaves (2/2000)^2 / 24 times a second derivative of at most some 20.
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) EXPECT_NEAR(gram[i][j], i == j ? 1.0 : 0.0, 2e-6) << i << " " << j;
}

TEST(Sh, EvaluatesRadianceAndIrradiance) {
    EXPECT_NEAR(evaluate(kLk, kN7), 1.70647682641, kTolerance);
    EXPECT_NEAR(evaluate(convolve_cosine(kLk), kN7), 1.28818365433, kTolerance);
}

TEST(Sh, RotatesToAFrame) {
    constexpr std::array<double, 9> expected{3,
                                             0.171428571429,
                                             1.11428571429,
                                             -0.242857142857,
                                             -0.0390345572266,
                                             0.114788028404,
                                             0.500567686165,
                                             -0.0242465288228,
                                             0.267664172584};
    const auto rotated = rotate(kLk, kFrame7);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(rotated.c[i], expected[i], kTolerance) << i;
}

TEST(Sh, RotationKeepsTheFunction) {
    const auto rotated = rotate(kLk, kFrame7);
    for (const Vec3 w : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0.48f, 0.6f, -0.64f}, kN7}) {
        const Vec3 w_frame{dot(kFrame7[0], w), dot(kFrame7[1], w), dot(kFrame7[2], w)};
        EXPECT_NEAR(evaluate(rotated, w_frame), evaluate(kLk, w), kTolerance);
    }
}

TEST(Sh, ZonalCoefficientsAreThoseOfTheRotatedFrame) {
    const auto rotated = rotate(kLk, kFrame7);
    const auto zonal = zonal_coefficients(kLk, kN7);
    EXPECT_NEAR(zonal[0], rotated.c[0], kTolerance);
    EXPECT_NEAR(zonal[1], rotated.c[2], kTolerance);
    EXPECT_NEAR(zonal[2], rotated.c[6], kTolerance);
}

// Convolution with the clamped cosine by brute force: I(n) = (1/pi) integral of L max(n.w, 0).
TEST(Sh, CosineBandsAreThoseOfTheClampedCosine) {
    const auto irradiance = convolve_cosine(kLk);
    for (const Vec3 n : {kN7, Vec3{0, 0, 1}, Vec3{-0.6f, 0, 0.8f}}) {
        double sum = 0;
        for_sphere([&](Vec3 w, double dw) { sum += evaluate(kLk, w) * std::max(0.0f, dot(n, w)) * dw / M_PI; });
        // 16 azimuths integrate the kinked cosine to some 1e-3.
        EXPECT_NEAR(sum, evaluate(irradiance, n), 3e-3);
    }
}

// Bands 0 to 2 of the clamped cosine sum to 1/4 + 1/2 + 5/16 = 1.0625 at its peak.
TEST(Sh, DirectionalLightPeaksAsTheTruncatedCosineDoes) {
    const auto irradiance = convolve_cosine(directional_light(1.9f, kN7));
    EXPECT_NEAR(evaluate(irradiance, kN7), 1.9 * 1.0625, 4e-6);
}

TEST(Sh, HemisphereLightGivesHalfOnePlusCosine) {
    const auto irradiance = convolve_cosine(hemisphere_light(0.7f, kN7));
    for (const Vec3 n : {kN7, Vec3{0, 0, 1}, Vec3{1, 0, 0}, -kN7})
        EXPECT_NEAR(evaluate(irradiance, n), 0.7 * (1 + dot(n, kN7)) / 2, kTolerance);
}

TEST(Sh, HemisphereAndDirectionalLightAsLinearSh) {
    constexpr std::array<double, 4> expected{2.92454885399, -1.24992047899, 3.57433400133, -0.833280319328};
    const auto directional = directional_light(1.9f, kN7), hemisphere = hemisphere_light(0.7f, Vec3{0, 0, 1});
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(directional.c[i] + hemisphere.c[i], expected[i], 2 * kTolerance) << i;
}

TEST(Sh, ProjectionOverUniformSphereSamplesRecoversTheCoefficients) {
    std::array<double, 9> sum{};
    int count = 0;
    for_sphere([&](Vec3 w, double) {
        const auto sample = project_sample<9>(evaluate(kLk, w), w, float(1 / (4 * M_PI)));
        for (std::size_t i = 0; i < 9; ++i) sum[i] += sample.c[i];
        ++count;
    });
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(sum[i] / count, kLk.c[i], 1e-5) << i;
}

TEST(Sh, OptimalLinearDirection) {
    const auto light = directional_light(Vec3{0.2f, 1.0f, 3.0f}, kN7);
    const Vec3 d = optimal_linear_direction(luminance(light), Vec3{0, 1, 0});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(d[i], kN7[i], 1e-6);
    EXPECT_EQ(optimal_linear_direction(RadianceSh<float, 4>{}, Vec3{0, 1, 0}), (Vec3{0, 1, 0}));
}

// Linear part of a constant: same for every channel of an RGB signal.
TEST(Sh, ChannelsAreIndependent) {
    RadianceSh<Vec3, 9> rgb;
    for (std::size_t i = 0; i < 9; ++i) rgb.c[i] = Vec3{1, 2, -3} * kLk.c[i];
    const Vec3 value = evaluate(convolve_cosine(rotate(rgb, kFrame7)), Vec3{0, 0, 1});
    const float scalar = evaluate(convolve_cosine(kLk), kN7);
    EXPECT_NEAR(value.x, scalar, kTolerance);
    EXPECT_NEAR(value.y, 2 * scalar, 2 * kTolerance);
    EXPECT_NEAR(value.z, -3 * scalar, 3 * kTolerance);
    EXPECT_NEAR(evaluate(linear_part(rgb), Vec3{0, 0, 1}).x, kSh0 * 3 + kSh1 * .9f, kTolerance);
}

}  // namespace
}  // namespace lumel
