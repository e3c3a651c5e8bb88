// L1 spherical harmonics with the linear band divided by the constant one: four numbers per channel, of which only one
// is HDR.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (storage and linear evaluation); Hazel 2017,
// "Converting SH Radiance to Irradiance" (the non-linear evaluation).
//
// l0 = R0 = mean radiance over the sphere, l1n = R1/R0 with R1 the mean of radiance times direction; |l1n| <= 1, its
// components are signed. Lightmap texels hold no light from below their horizon, so uniform light has |l1n| = 1/2.
#pragma once

#include <array>

#include "encode/encoding.h"
#include "encode/hhd.h"
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
float evaluate_hazel(float l0, Vec3 l1n, Vec3 n);

// As a hemisphere light, a directional light and a ring on the horizon (hhd.h), for light from above the horizon only:
// never negative, exact at n_v = +z; n is of the tangent frame, and so is l1n.
Vec3 evaluate_l1_hhd(const L1Texel& texel, Vec3 n);

// The texel as numbers of an encoding: L0, then the vectors of R, G and B.
inline constexpr std::array<Field, 12> kL1Fields{
    Field{"L0.R", FieldKind::light}, {"L0.G", FieldKind::light},    {"L0.B", FieldKind::light},
    {"L1n.R.X", FieldKind::ratio},   {"L1n.R.Y", FieldKind::ratio}, {"L1n.R.Z", FieldKind::ratio},
    {"L1n.G.X", FieldKind::ratio},   {"L1n.G.Y", FieldKind::ratio}, {"L1n.G.Z", FieldKind::ratio},
    {"L1n.B.X", FieldKind::ratio},   {"L1n.B.Y", FieldKind::ratio}, {"L1n.B.Z", FieldKind::ratio}};
Numbers to_numbers(const L1Texel& texel);
L1Texel l1_texel(const Numbers& numbers);
void rotate_l1(Numbers& numbers, const Rotation& rotation);
// Of texels whose L0 and L0 L1n are linear in the light (all but those fitted to Hazel's evaluation), one after the
// other; both in one frame.
Numbers blend_l1(const Numbers& a, float weight_a, const Numbers& b, float weight_b);

}  // namespace lumel
