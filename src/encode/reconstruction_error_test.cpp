#include "encode/reconstruction_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "encode/encodings.h"

namespace lumel {
namespace {

TexelLight light_of(const RadianceSh<Vec3, 9>& radiance, Vec3 irradiance) {
    return {radiance, fit_irradiance(radiance), irradiance};
}

MeasuredTexels uniform_light() {
    MeasuredTexels out;
    for (int i = 0; i < 4; ++i) {
        const Vec3 color = Vec3{1, 2, 0.5f} * float(1 + i);
        out.light.push_back(light_of(hemisphere_light(color, Vec3{0, 0, 1}), color));
        out.frame.push_back(tangent_frame(normalize(Vec3{0.3f, 0.9f, -0.2f})));
    }
    out.neighbours = {{0, 1}, {2, 3}};
    return out;
}

// Stores I about n_v and decodes it, too bright by a tenth, about every normal.
constexpr std::array<Field, 3> kTestFields{Field{"I.R", FieldKind::signed_light}, Field{"I.G", FieldKind::signed_light},
                                           Field{"I.B", FieldKind::signed_light}};
void solve_test(std::span<const TexelLight> light, std::span<Numbers> out) {
    for (std::size_t i = 0; i < light.size(); ++i) {
        out[i] = {};
        detail::store_vec3(out[i], 0, light[i].irradiance);
    }
}
Vec3 decode_test(const Numbers& numbers, Vec3) { return detail::vec3_at(numbers, 0) * 1.1f; }
const Encoding kTest{"test", "", kTestFields, nullptr, false, 0, solve_test, decode_test, detail::blend_numbers};

// Uniform light, which HHD holds, and I_z alone does not: its error is the deviation of (1 + z)/2 from 1, whose mean
// square over the hemisphere is the integral of ((1 - z)/2)^2 = 1/12. Of colours k (1, 2, 1/2), k = 1..4, the mean is
// 3/4 of their 7/6 * 5/2, their mean square 7.5 * 5.25/3.
TEST(ReconstructionError, OfUniformLight) {
    const double expected = std::sqrt(7.5 * 1.75 / 12) / (0.75 * 7.0 / 6 * 2.5);
    const ReconstructionError plain = measure(kIrradianceEncoding, Storage::exact, uniform_light());
    EXPECT_NEAR(plain.nrmse, expected, 1e-4);
    EXPECT_NEAR(plain.at_normal, 0.0, 1e-6);
    // Of texel k alone, over its mean and a hundredth of that of all, which is the mean of k = 2.5.
    const auto of_texel = [](double k) { return k * std::sqrt(1.75 / 12) / (0.75 * 3.5 / 3 * (k + 0.025)); };
    EXPECT_NEAR(plain.worst, of_texel(4), 1e-4);
    EXPECT_NEAR(plain.p99, of_texel(3), 1e-4);  // of four texels, the last that is not beyond 99 of 100
    const ReconstructionError hhd = measure(kL1Hhd, Storage::exact, uniform_light());
    EXPECT_LT(hhd.nrmse, 2e-4);
    EXPECT_LT(hhd.between, 2e-4);
    EXPECT_EQ(hhd.outside, 0.0);
}

TEST(ReconstructionError, RoundingShows) {
    const double exact = measure(kL1Hhd, Storage::exact, uniform_light()).nrmse;
    const double half = measure(kL1Hhd, Storage::half, uniform_light()).nrmse;
    const double texture = measure(kL1Hhd, Storage::texture, uniform_light()).nrmse;
    EXPECT_GT(half, exact);
    EXPECT_GT(texture, 2 * half);
    EXPECT_LT(texture, 0.02);
}

// Two lights from opposite sides: half way between them plain AHD is brighter or darker about n_v than both, IrradZ
// not.
TEST(ReconstructionError, FilteredAhdLeavesTheInterval) {
    MeasuredTexels texels;
    for (const float side : {-1.0f, 1.0f}) {
        const Vec3 d = normalize(Vec3{side * 2, 0, 1});
        texels.light.push_back(light_of(directional_light(Vec3{1, 1, 1}, d), Vec3{1, 1, 1} * d.z));
        texels.frame.push_back(tangent_frame({0, 1, 0}));
    }
    texels.neighbours = {{0, 1}};
    EXPECT_EQ(measure(kAhd, Storage::exact, texels).outside, 1.0);
    EXPECT_EQ(measure(kIrradZAhd, Storage::exact, texels).outside, 0.0);
    EXPECT_EQ(measure(kIrradZHhd, Storage::texture, texels).outside, 0.0);
}

TEST(ReconstructionError, AtTheNormal) {
    const double expected = 0.1 * std::sqrt(7.5 * 1.75) / (2.5 * 3.5 / 3);
    EXPECT_NEAR(measure(kTest, Storage::exact, uniform_light()).at_normal, expected, 1e-5);
}

// The mean of two equal numbers lies between them, whatever their sign.
TEST(ReconstructionError, NegativeNumbersLieBetweenThemselves) {
    MeasuredTexels texels = uniform_light();
    for (TexelLight& light : texels.light) light.irradiance = Vec3{-1, -2, -3};
    EXPECT_EQ(measure(kTest, Storage::exact, texels).outside, 0.0);
}

// Squares beyond float are still errors; what is no number is the worst of all, never none.
TEST(ReconstructionError, WhatIsNoNumberIsInfinite) {
    MeasuredTexels bright = uniform_light();
    for (Vec3& c : bright.light[1].radiance.c) c *= 1e25f;
    const ReconstructionError large = measure(kTest, Storage::exact, bright);
    EXPECT_GT(large.nrmse, 0.5);
    EXPECT_TRUE(std::isfinite(large.nrmse));
    for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        MeasuredTexels texels = uniform_light();
        texels.light[2].irradiance.x = bad;
        const ReconstructionError of_light = measure(kTest, Storage::exact, texels);
        for (const double e : {of_light.nrmse, of_light.worst, of_light.at_normal, of_light.between})
            EXPECT_EQ(e, std::numeric_limits<double>::infinity()) << bad;
        EXPECT_TRUE(std::isfinite(of_light.p99)) << bad;  // of the other texels
        EXPECT_EQ(of_light.outside, 0.5) << bad;
        texels = uniform_light();
        texels.light[2].radiance.c[0].x = bad;
        EXPECT_EQ(measure(kTest, Storage::exact, texels).nrmse, std::numeric_limits<double>::infinity()) << bad;
    }
}

TEST(ReconstructionError, NothingAndDarknessAreNoError) {
    EXPECT_EQ(measure(kIrradZHhd, Storage::exact, {}).nrmse, 0.0);
    MeasuredTexels dark{{TexelLight{}}, {tangent_frame({0, 1, 0})}, {}};
    EXPECT_EQ(measure(kIrradZHhd, Storage::exact, dark).nrmse, 0.0);
}

}  // namespace
}  // namespace lumel
