#include "encode/l1.h"

#include <algorithm>
#include <cmath>

#include "sh/rotate.h"

namespace lumel {
namespace {

// R1 = v / (4 pi k1), with 4 pi k1 = sqrt(12 pi).
constexpr float kInv4PiK1 = 0.16286750396763997f;

float hazel(float r0, Vec3 l1n, Vec3 n) {
    const float length_l1n = length(l1n);
    const float r = std::min(length_l1n, 1.0f);
    if (!(r > 0.0f)) return r0;
    const float q = std::clamp(0.5f * (1.0f + dot(l1n, n) / length_l1n), 0.0f, 1.0f);
    const float p = 1.0f + 2.0f * r;
    const float a = (1.0f - r) / (1.0f + r);
    return r0 * (a + (1.0f - a) * (p + 1.0f) * std::pow(q, p));
}

}  // namespace

L1Texel encode_l1(const RadianceSh<Vec3, 4>& radiance) {
    L1Texel out;
    const ShVector<Vec3> v = linear_vector(radiance.c);
    for (std::size_t c = 0; c < 3; ++c) {
        const float r0 = radiance.c[0][c] * kSh0;
        if (!(r0 > 0.0f)) continue;
        out.l0[c] = r0;
        out.l1n[c] = Vec3{v.x[c], v.y[c], v.z[c]} * (kInv4PiK1 / r0);
    }
    return out;
}

Vec3 evaluate_l1_linear(const L1Texel& texel, Vec3 n) {
    Vec3 out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = (0.5f + dot(texel.l1n[c], n)) * texel.l0[c] * 2.0f;
    return out;
}

Vec3 evaluate_l1_hazel(const L1Texel& texel, Vec3 n) {
    Vec3 out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = hazel(texel.l0[c], texel.l1n[c], n);
    return out;
}

}  // namespace lumel
