// Known answers from an independent double-precision program; a few roundings of float.
#include "encode/hhd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lumel {
namespace {

constexpr float kTolerance = 2e-6f;
constexpr Vec3 kN7{2.0f / 7, 3.0f / 7, 6.0f / 7}, kUp{0, 0, 1};

void expect_hhd(const Hhd& hhd, double iz, double ambient, double directional, Vec3 direction) {
    EXPECT_NEAR(hhd.iz, iz, kTolerance);
    EXPECT_NEAR(hhd.ambient, ambient, kTolerance);
    EXPECT_NEAR(hhd.directional, directional, kTolerance);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(hhd.direction[c], direction[c], kTolerance) << c;
}

TEST(Hhd, KnownAnswers) {
    expect_hhd(solve_hhd({2.5f, {.6f, -.3f, 1.6f}}), 1.6, 0.681178001125, 1.13764399775,
               {0.527405762424f, -0.263702881212f, 0.807653361414f});
    // The ambient part clamped to 0, to I_z; light from behind.
    expect_hhd(solve_hhd({1.0f, {.9f, .3f, .8f}}), 0.8, 0.0, 1.2409673646,
               {0.725240667623f, 0.241746889208f, 0.64465837122f});
    expect_hhd(solve_hhd({2.0f, {.1f, 0, .3f}}), 0.3, 0.3, 0.1, {1, 0, 0});
    expect_hhd(solve_hhd({2.0f, {.5f, 0, -.4f}}), 0.0, 0.0, 0.5, {1, 0, 0});
}

TEST(Hhd, RingKnownAnswer) {
    const Hhd hhd = solve_hhd_ring({2.0f, {.1f, 0, .3f}});
    expect_hhd(hhd, 0.3, 0.3, 0.1, {1, 0, 0});
    EXPECT_NEAR(hhd.ring, 1.3, kTolerance);
    EXPECT_NEAR(evaluate(hhd, kN7), 0.520283914423, kTolerance);
    EXPECT_EQ(solve_hhd_ring({2.0f, {.5f, 0, -.4f}}).ring, 0.0f) << "no ring for light from behind";
}

TEST(Hhd, MomentsAreThoseOfLinearSh) {
    const auto light = directional_light(1.9f, kN7), ambient = hemisphere_light(0.7f, kUp);
    std::array<float, 4> l;
    for (std::size_t i = 0; i < 4; ++i) l[i] = light.c[i] + ambient.c[i];
    const LightMoments m = light_moments(l), expected = moments_of(Hhd{0, 0.7f, 1.9f, kN7, 0});
    EXPECT_NEAR(m.scalar, expected.scalar, 2 * kTolerance);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(m.vector[c], expected.vector[c], 2 * kTolerance);
    expect_hhd(solve_hhd(m), 0.7 + 1.9 * 6 / 7, 0.7, 1.9, kN7);
}

// Any light from above: all terms are there or zero, all moments are kept, I at n_v is exact. Near-ambient light, whose
// discriminant would cancel in the form that was published, among them.
TEST(Hhd, KeepsTheMomentsOfLightFromAbove) {
    std::mt19937 random(3);  // the standard says which numbers it gives
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    for (int i = 0; i < 5000; ++i) {
        LightMoments m;
        for (int k = 0; k < 1 + i % 4; ++k) {
            const float z = uniform() * (i % 2 ? 0.1f : 1.0f), turn = 6.2831853f * uniform();
            const float r = std::sqrt(1 - z * z), power = i % 3 ? uniform() : 1e-3f * uniform();
            m.scalar += power;
            m.vector += Vec3{r * std::cos(turn), r * std::sin(turn), z} * power;
        }
        if (i % 3 == 0) {
            m.scalar += 2.0f;
            m.vector.z += 1.0f;
        }
        const Hhd hhd = solve_hhd_ring(m);
        ASSERT_TRUE(hhd.ambient >= 0 && hhd.directional >= 0 && hhd.ring >= 0) << i;
        const LightMoments back = moments_of(hhd);
        const float near = 3e-6f * m.scalar;
        ASSERT_NEAR(back.scalar, m.scalar, near) << i;
        for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(back.vector[c], m.vector[c], near) << i;
        ASSERT_NEAR(evaluate(hhd, kUp), m.vector.z, near) << i;
    }
}

TEST(Hhd, DarknessAndPureAmbient) {
    EXPECT_EQ(evaluate(solve_hhd_ring({}), kN7), 0.0f);
    const Hhd ambient = solve_hhd_ring({2.0f, {0, 0, 1}});
    EXPECT_NEAR(ambient.ambient, 1.0f, kTolerance);
    EXPECT_NEAR(evaluate(ambient, kN7), (1 + kN7.z) / 2, kTolerance);
}

// 6000 azimuths of light at the horizon: I = sin(theta)/pi for b_c = 1.
TEST(Hhd, RingIsLightAlongTheHorizon) {
    for (const float theta : {0.3f, 1.0f, 1.5707963f}) {
        double sum = 0;
        for (int k = 0; k < 6000; ++k)
            sum += std::max(0.0, std::cos(2 * M_PI * (k + 0.5) / 6000) * std::sin(double(theta))) / 6000;
        Hhd ring;
        ring.ring = 1.0f;
        EXPECT_NEAR(evaluate(ring, {std::sin(theta), 0, std::cos(theta)}), sum, 1e-6);
    }
}

}  // namespace
}  // namespace lumel
