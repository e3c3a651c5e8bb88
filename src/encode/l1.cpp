#include "encode/l1.h"

#include <algorithm>
#include <cmath>

#include "encode/encodings.h"
#include "sh/rotate.h"

namespace lumel {
namespace {

// R1 = v / (4 pi k1), with 4 pi k1 = sqrt(12 pi).
constexpr float kInv4PiK1 = 0.16286750396763997f;

Numbers solve(const TexelLight& light) { return to_numbers(encode_l1(linear_part(light.radiance))); }

template <Vec3 (*kEvaluate)(const L1Texel&, Vec3)>
Vec3 decode(const Numbers& numbers, Vec3 normal) {
    return kEvaluate(l1_texel(numbers), normal);
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

float evaluate_hazel(float l0, Vec3 l1n, Vec3 n) {
    const float length_l1n = length(l1n);
    const float r = std::min(length_l1n, 1.0f);
    if (!(r > 0.0f)) return l0;
    const float q = std::clamp(0.5f * (1.0f + dot(l1n, n) / length_l1n), 0.0f, 1.0f);
    const float p = 1.0f + 2.0f * r;
    const float a = (1.0f - r) / (1.0f + r);
    return l0 * (a + (1.0f - a) * (p + 1.0f) * std::pow(q, p));
}

Vec3 evaluate_l1_hazel(const L1Texel& texel, Vec3 n) {
    Vec3 out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = evaluate_hazel(texel.l0[c], texel.l1n[c], n);
    return out;
}

Vec3 evaluate_l1_hhd(const L1Texel& texel, Vec3 n) {
    Vec3 out;
    for (std::size_t c = 0; c < 3; ++c) {
        const float scalar = 4.0f * texel.l0[c];
        out[c] = evaluate(solve_hhd_ring({scalar, texel.l1n[c] * scalar}), n);
    }
    return out;
}

Numbers to_numbers(const L1Texel& texel) {
    Numbers out{};
    detail::store_vec3(out, 0, texel.l0);
    for (std::size_t c = 0; c < 3; ++c) detail::store_vec3(out, 3 + 3 * c, texel.l1n[c]);
    return out;
}

L1Texel l1_texel(const Numbers& numbers) {
    L1Texel out{detail::vec3_at(numbers, 0), {}};
    for (std::size_t c = 0; c < 3; ++c) out.l1n[c] = detail::vec3_at(numbers, 3 + 3 * c);
    return out;
}

void rotate_l1(Numbers& numbers, const Rotation& rotation) {
    for (std::size_t i = 3; i < 12; i += 3)
        detail::store_vec3(numbers, i, to_tangent(rotation, detail::vec3_at(numbers, i)));
}

Numbers blend_l1(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    const L1Texel x = l1_texel(a), y = l1_texel(b);
    L1Texel out;
    for (std::size_t c = 0; c < 3; ++c) {
        const float wx = x.l0[c] * weight_a, wy = y.l0[c] * weight_b;
        out.l0[c] = wx + wy;
        if (out.l0[c] > 0.0f) out.l1n[c] = (x.l1n[c] * wx + y.l1n[c] * wy) / out.l0[c];
    }
    return to_numbers(out);
}

const Encoding kL1Linear{"l1-linear",
                         "L1/L0 per channel, evaluated linearly",
                         kL1Fields,
                         rotate_l1,
                         false,
                         15,
                         detail::solve_each<solve>,
                         decode<evaluate_l1_linear>,
                         blend_l1};
const Encoding kL1Hazel{"l1-hazel",
                        "L1/L0 per channel, Hazel's evaluation",
                        kL1Fields,
                        rotate_l1,
                        false,
                        99,
                        detail::solve_each<solve>,
                        decode<evaluate_l1_hazel>,
                        blend_l1};
const Encoding kL1Hhd{"l1-hhd",
                      "L1/L0 per channel, as hemisphere, directional light and horizon ring",
                      kL1Fields,
                      rotate_l1,
                      true,
                      120,
                      detail::solve_each<solve>,
                      decode<evaluate_l1_hhd>,
                      blend_l1};

}  // namespace lumel
