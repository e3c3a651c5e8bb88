// ZH3: linear SH and one zonal coefficient of band 2 per channel about the luminance's main direction; stored, or
// guessed from the linear band. Based on: Roughton et al. 2024, "ZH3: Quadratic Zonal Harmonics".
#include <algorithm>
#include <cmath>

#include "encode/encodings.h"
#include "encode/l1.h"

namespace lumel {
namespace {

// As L1, and z2/(sqrt5 l0), which is 1 for a single direction.
constexpr Field kFields[] = {kL1Fields[0],
                             kL1Fields[1],
                             kL1Fields[2],
                             kL1Fields[3],
                             kL1Fields[4],
                             kL1Fields[5],
                             kL1Fields[6],
                             kL1Fields[7],
                             kL1Fields[8],
                             kL1Fields[9],
                             kL1Fields[10],
                             kL1Fields[11],
                             {"Z2.R", FieldKind::ratio},
                             {"Z2.G", FieldKind::ratio},
                             {"Z2.B", FieldKind::ratio}};
constexpr float kSqrt5 = 2.2360679774997897f, kSqrt3 = 1.7320508075688772f;

Vec3 axis_of(const L1Texel& texel) {
    const Vec3 v = texel.l1n[0] * (0.2126f * texel.l0.x) + texel.l1n[1] * (0.7152f * texel.l0.y) +
                   texel.l1n[2] * (0.0722f * texel.l0.z);
    return normalize_or(v, {0, 0, 1});
}

Numbers store(const L1Texel& texel, Vec3 z2_ratio) {
    Numbers out = to_numbers(texel);
    detail::store_vec3(out, 12, z2_ratio);
    return out;
}

Numbers solve(const TexelLight& light) {
    const L1Texel texel = encode_l1(linear_part(light.radiance));
    const Vec3 z2 = zonal_coefficients(light.radiance, axis_of(texel))[2];
    Vec3 ratio;
    for (std::size_t c = 0; c < 3; ++c)
        if (texel.l0[c] > 0.0f) ratio[c] = std::clamp(z2[c] / (kSqrt5 * light.radiance.c[0][c]), -1.0f, 1.0f);
    return store(texel, ratio);
}

Numbers solve_linear(const TexelLight& light) { return to_numbers(encode_l1(linear_part(light.radiance))); }

// 3 cos^2 - 1 about the axis.
float zonal(Vec3 axis, Vec3 n) {
    const float c = dot(axis, n);
    return 3.0f * c * c - 1.0f;
}

Vec3 decode(const Numbers& numbers, Vec3 n) {
    const L1Texel texel = l1_texel(numbers);
    const float z = 5.0f / 8.0f * zonal(axis_of(texel), n);
    return evaluate_l1_linear(texel, n) + texel.l0 * detail::vec3_at(numbers, 12) * z;
}

Vec3 decode_hallucinated(const Numbers& numbers, Vec3 n) {
    const L1Texel texel = l1_texel(numbers);
    const Vec3 axis = axis_of(texel);
    const float z = kSqrt5 / 8.0f * zonal(axis, n);
    Vec3 out = evaluate_l1_linear(texel, n);
    for (std::size_t c = 0; c < 3; ++c) {
        const float ratio = kSqrt3 * std::fabs(dot(texel.l1n[c], axis));
        out[c] += texel.l0[c] * z * ratio * (0.08f + 0.6f * ratio);
    }
    return out;
}

// Band 2 of both, each about its own axis, as it is about the new one.
Numbers blend(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    const L1Texel texel = l1_texel(blend_l1(a, weight_a, b, weight_b));
    const Vec3 axis = axis_of(texel);
    const auto band2 = [&](const Numbers& numbers, float weight) {
        const L1Texel old = l1_texel(numbers);
        return old.l0 * detail::vec3_at(numbers, 12) * (0.5f * weight * zonal(axis_of(old), axis));
    };
    const Vec3 z2 = band2(a, weight_a) + band2(b, weight_b);
    Vec3 ratio;
    for (std::size_t c = 0; c < 3; ++c)
        if (texel.l0[c] > 0.0f) ratio[c] = z2[c] / texel.l0[c];
    return store(texel, ratio);
}

}  // namespace

const Encoding kZh3{
    "zh3", "L1/L0 per channel and a zonal band 2", kFields, rotate_l1, false, 51, detail::solve_each<solve>, decode,
    blend};
const Encoding kZh3Hallucinated{"zh3-hallucinated",
                                "L1/L0 per channel, band 2 guessed from it",
                                kL1Fields,
                                rotate_l1,
                                false,
                                66,
                                detail::solve_each<solve_linear>,
                                decode_hallucinated,
                                blend_l1};

}  // namespace lumel
