// An orthonormal frame about a unit normal. Based on: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
#pragma once

#include <cmath>

#include "lumel/vec.h"

namespace lumel {

struct Frame {
    Vec3 tangent, bitangent, normal;

    explicit Frame(Vec3 n) : normal(n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }
    [[nodiscard]] Vec3 to_world(Vec3 v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
    [[nodiscard]] Vec3 to_local(Vec3 v) const { return {dot(v, tangent), dot(v, bitangent), dot(v, normal)}; }
};

// Unit vector along a finite one of any length but zero, which gives `fallback`: squares in double do not overflow.
inline Vec3 unit_or(Vec3 v, Vec3 fallback) {
    const double x = v.x, y = v.y, z = v.z;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 0.0)) return fallback;
    return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

}  // namespace lumel
