// HHD: a hemisphere light about n_v, a directional light and, where those two cannot hold the moments, a ring of light
// on the horizon: I(n) = C_a (1 + n_v.n)/2 + C_d max(n.d, 0) + (e/pi) sqrt(1 - (n_v.n)^2).
// Based on: Roughton 2024, "Hemispherical Lighting Insights" (HHD and its closed form). Different here: the
// discriminant as a sum of squares, which does not cancel; clamps that keep I_z; the ring, with which every moment of
// light from above the horizon is kept.
#pragma once

#include "encode/texel_light.h"

namespace lumel {

struct Hhd {
    float iz = 0.0f;           // I at n_v
    float ambient = 0.0f;      // C_a
    float directional = 0.0f;  // C_d
    Vec3 direction{0, 0, 1};
    float ring = 0.0f;  // e
};

// Tangent frame. Light from below (moments no light from above has) is dropped; I_z = b.n_v is kept but for that, and
// b, too.
Hhd solve_hhd(const LightMoments& moments);
// The same with the ring: keeps b_c as well.
Hhd solve_hhd_ring(const LightMoments& moments);

LightMoments moments_of(const Hhd& hhd);
float evaluate(const Hhd& hhd, Vec3 n);

}  // namespace lumel
