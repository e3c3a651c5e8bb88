#include "encode/hhd.h"

#include <algorithm>
#include <cmath>

namespace lumel {

Hhd solve_hhd(const LightMoments& moments) {
    Hhd out;
    Vec3 b = moments.vector;
    b.z = std::max(b.z, 0.0f);
    out.iz = b.z;
    const float q = moments.scalar - 2.0f * moments.vector.z;
    const float root = std::sqrt(q * q + 3.0f * (b.x * b.x + b.y * b.y));
    out.ambient = std::clamp((2.0f * moments.scalar - moments.vector.z - root) / 3.0f, 0.0f, out.iz);
    const Vec3 rest{b.x, b.y, b.z - out.ambient};
    out.directional = length(rest);
    // Below rounding of the moments there is no direction to speak of.
    constexpr float kNothing = 1e-6f;
    if (out.directional > kNothing * moments.scalar && out.directional > 0.0f)
        out.direction = rest / out.directional;
    else
        out.directional = rest.z;
    return out;
}

Hhd solve_hhd_ring(const LightMoments& moments) {
    Hhd out = solve_hhd(moments);
    const Vec3 b = moments.vector;
    if (b.z >= 0.0f) out.ring = std::max(0.0f, moments.scalar - 2.0f * b.z - std::sqrt(b.x * b.x + b.y * b.y));
    return out;
}

LightMoments moments_of(const Hhd& hhd) {
    return {2.0f * hhd.ambient + hhd.directional + hhd.ring, Vec3{0, 0, hhd.ambient} + hhd.direction * hhd.directional};
}

float evaluate(const Hhd& hhd, Vec3 n) {
    return hhd.ambient * 0.5f * (1.0f + n.z) + hhd.directional * std::max(dot(n, hhd.direction), 0.0f) +
           hhd.ring * kInvPi * std::sqrt(std::max(0.0f, 1.0f - n.z * n.z));
}

}  // namespace lumel
