// L1 spherical harmonics with the linear band divided by the constant one: four numbers per channel, of which only one
// is HDR.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (storage and linear evaluation); Hazel 2017,
// "Converting SH Radiance to Irradiance" (the non-linear evaluation).
//
// l0 = R0 = mean radiance over the sphere, l1n = R1/R0 with R1 the mean of radiance times direction; |l1n| <= 1, its
// components are signed. Lightmap texels hold no light from below their horizon, so uniform light has |l1n| = 1/2.
#pragma once

#include <array>

#include "sh/coefficients.h"

namespace lumel {

struct L1Texel {
    Vec3 l0{};                  // R, G, B
    std::array<Vec3, 3> l1n{};  // per channel a vector in the frame of the input (world for files)
};

// Per channel; where the constant band is not positive the texel is black.
L1Texel encode_l1(const RadianceSh<Vec3, 4>& radiance);

// I = E/pi = (1/2 + l1n.n) * 2 l0: exact for linear bands, negative where |l1n| > 1/2 on the far side.
Vec3 evaluate_l1_linear(const L1Texel& texel, Vec3 n);

// Never negative, same mean over all n, exact in I(n) - I(-n) along the main direction.
Vec3 evaluate_l1_hazel(const L1Texel& texel, Vec3 n);

}  // namespace lumel
