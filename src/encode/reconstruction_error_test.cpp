#include "encode/reconstruction_error.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Uniform light, which HHD holds, and I_z alone does not: its error is the deviation of (1 + z)/2 from 1, whose mean
// square over the hemisphere is the integral of ((1 - z)/2)^2 = 1/12. Of colours k (1, 2, 1/2), k = 1..4, the mean is
// 3/4 of their 7/6 * 5/2, their mean square 7.5 * 5.25/3.
TEST(ReconstructionError, OfUniformLight) {
    const double expected = std::sqrt(7.5 * 1.75 / 12) / (0.75 * 7.0 / 6 * 2.5);
    EXPECT_NEAR(measure(kIrradianceEncoding, Storage::exact, uniform_light()).nrmse, expected, 1e-4);
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

TEST(ReconstructionError, NothingAndDarknessAreNoError) {
    EXPECT_EQ(measure(kIrradZHhd, Storage::exact, {}).nrmse, 0.0);
    MeasuredTexels dark{{TexelLight{}}, {tangent_frame({0, 1, 0})}, {}};
    EXPECT_EQ(measure(kIrradZHhd, Storage::exact, dark).nrmse, 0.0);
}

}  // namespace
}  // namespace lumel
