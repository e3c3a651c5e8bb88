// Warps from the unit square, each a family: sample, pdf, and inverse where a test needs it.
// Based on: Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., appendix A.
#pragma once

#include <algorithm>
#include <cmath>

#include "lumel/vec.h"
#include "math/constants.h"
#include "math/trig.h"

namespace lumel {

inline Vec3 direction_from_z(float z, float u) {
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const SinCos sc = sincos_turn(u);
    return {r * sc.cosine, r * sc.sine, z};
}

// Hemisphere about +z with density proportional to 1/2 + cos: between uniform, best for the SH vector, and
// cosine-weighted, best for the irradiance. z = (sqrt(1 + 8u) - 1) / 2 inverts F(z) = (z + z^2)/2.
struct GatherHemisphere {
    static Vec3 sample(Vec2 u) { return direction_from_z((std::sqrt(1.0f + 8.0f * u.x) - 1.0f) * 0.5f, u.y); }
    static float pdf(float cosine) { return cosine >= 0.0f ? (0.5f + cosine) * kInvTwoPi : 0.0f; }
    static float inverse_u(float z) { return 0.5f * (z + z * z); }
    // Where in the unit square a direction comes from.
    static Vec2 inverse(Vec3 local) {
        const auto turn = static_cast<float>(arctangent2(local.y, local.x)) * kInvTwoPi;
        return {inverse_u(std::clamp(local.z, 0.0f, 1.0f)), turn < 0.0f ? turn + 1.0f : turn};
    }
};

struct CosineHemisphere {
    static Vec3 sample(Vec2 u) { return direction_from_z(std::sqrt(u.x), u.y); }
    static float pdf(float cosine) { return cosine > 0.0f ? cosine * kInvPi : 0.0f; }
    static float inverse_u(float z) { return z * z; }
};

// Cone of directions about +z, uniform in solid angle; `one_minus_cos` = 1 - cos(half angle), kept for small cones.
struct UniformCone {
    static Vec3 sample(Vec2 u, float one_minus_cos) {
        const float h = u.x * one_minus_cos;  // 1 - z
        const float r = std::sqrt(std::max(0.0f, h * (2.0f - h)));
        const SinCos sc = sincos_turn(u.y);
        return {r * sc.cosine, r * sc.sine, 1.0f - h};
    }
    static float pdf(float one_minus_cos) { return kInvTwoPi / one_minus_cos; }
};

// Unit disc, area-preserving and continuous. Based on: Shirley and Chiu 1997.
struct ConcentricDisc {
    static Vec2 sample(Vec2 u) {
        const Vec2 p{2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f};
        if (p.x == 0.0f && p.y == 0.0f) return {0.0f, 0.0f};
        const bool wide = std::fabs(p.x) > std::fabs(p.y);
        const float r = wide ? p.x : p.y;
        const float turn = wide ? 0.125f * (p.y / p.x) : 0.25f - 0.125f * (p.x / p.y);
        const SinCos sc = sincos_turn(turn);
        return {r * sc.cosine, r * sc.sine};
    }
    static constexpr float pdf() { return kInvPi; }
};

// Barycentrics (b1, b2), uniform over the triangle. Based on: Heitz 2019, "A Low-Distortion Map Between Triangle and
// Square".
struct UniformTriangle {
    static Vec2 sample(Vec2 u) {
        if (u.y > u.x) {
            const float x = 0.5f * u.x;
            return {x, u.y - x};
        }
        const float y = 0.5f * u.y;
        return {u.x - y, y};
    }
};

}  // namespace lumel
