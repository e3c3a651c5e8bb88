// What an encoding is solved from: the light of one texel in its tangent frame (n_v = +z).
#pragma once

#include "encode/tangent_frame.h"
#include "lumel/vec.h"
#include "sh/hemisphere.h"

namespace lumel {

struct TexelLight {
    RadianceSh<Vec3, 9> radiance;  // zero below the horizon
    IrradianceSh<Vec3, 9> fit;     // I over the upper hemisphere of normals, its least squares in basis S
    Vec3 irradiance{};             // I about n_v, exact: what solvers keep
};

// From the master: coefficients of the world frame, and I sampled on its own.
inline TexelLight texel_light(const RadianceSh<Vec3, 9>& radiance_ws, Vec3 irradiance, const Rotation& frame) {
    const RadianceSh<Vec3, 9> radiance = rotate(radiance_ws, frame);
    return {radiance, fit_irradiance(radiance), max(irradiance, Vec3{})};
}

inline TexelLight blend(const TexelLight& a, float weight_a, const TexelLight& b, float weight_b) {
    TexelLight out;
    for (std::size_t i = 0; i < 9; ++i) {
        out.radiance.c[i] = a.radiance.c[i] * weight_a + b.radiance.c[i] * weight_b;
        out.fit.c[i] = a.fit.c[i] * weight_a + b.fit.c[i] * weight_b;
    }
    out.irradiance = a.irradiance * weight_a + b.irradiance * weight_b;
    return out;
}

// Moments of incident light over pi, per channel or of luminance: b_c = (1/pi) integral of L, b = (1/pi) integral of
// L w. I_z = b.n_v where nothing shines from below.
struct LightMoments {
    float scalar = 0.0f;
    Vec3 vector{};
};

inline LightMoments light_moments(const std::array<float, 4>& l) {
    constexpr float kTwoOverSqrtPi = 1.1283791670955126f, kTwoOverSqrt3Pi = 0.65147001587055998f;
    return {l[0] * kTwoOverSqrtPi, Vec3{-l[3], -l[1], l[2]} * kTwoOverSqrt3Pi};
}

template <std::size_t N>
LightMoments light_moments(const RadianceSh<Vec3, N>& sh, std::size_t channel) {
    return light_moments({sh.c[0][channel], sh.c[1][channel], sh.c[2][channel], sh.c[3][channel]});
}

}  // namespace lumel
