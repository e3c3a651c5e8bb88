// Monochrome L1: I_z in colour, the normalised linear band of the luminance. Decoded as HHD with the horizon ring and
// scaled to I_z, which is exact at n_v.
#include <algorithm>

#include "encode/encodings.h"
#include "encode/hhd.h"
#include "encode/l1.h"
#include "encode/lobe_search.h"

namespace lumel {
namespace {

constexpr Field kFields[] = {{"I.R", FieldKind::light},   {"I.G", FieldKind::light},   {"I.B", FieldKind::light},
                             {"L1n.X", FieldKind::ratio}, {"L1n.Y", FieldKind::ratio}, {"L1n.Z", FieldKind::ratio}};

Numbers store(Vec3 irradiance, const LightMoments& luminance_moments) {
    Numbers out{};
    detail::store_vec3(out, 0, irradiance);
    const bool lit = luminance_moments.scalar > 0.0f;
    detail::store_vec3(out, 3, lit ? luminance_moments.vector / luminance_moments.scalar : Vec3{0, 0, 0.5f});
    return out;
}

Numbers solve(const TexelLight& light) {
    const RadianceSh<float, 9> l = luminance(light.radiance);
    return store(light.irradiance, light_moments({l.c[0], l.c[1], l.c[2], l.c[3]}));
}

// Moments of unit I_z; the vector no nearer to the horizon than a lobe of irradz.cpp.
LightMoments unit_moments(const Numbers& numbers) {
    const Vec3 v = detail::vec3_at(numbers, 3);
    const float z = std::max(v.z, kLowestLobe);
    return {1.0f / z, Vec3{v.x, v.y, z} / z};
}

Vec3 decode(const Numbers& numbers, Vec3 n) {
    return detail::vec3_at(numbers, 0) * evaluate(solve_hhd_ring(unit_moments(numbers)), n);
}

Numbers blend(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    const Vec3 ia = detail::vec3_at(a, 0) * weight_a, ib = detail::vec3_at(b, 0) * weight_b;
    const LightMoments ma = unit_moments(a), mb = unit_moments(b);
    const float la = luminance(ia), lb = luminance(ib);
    return store(ia + ib, {ma.scalar * la + mb.scalar * lb, ma.vector * la + mb.vector * lb});
}

void rotate(Numbers& numbers, const Rotation& rotation) {
    detail::store_vec3(numbers, 3, to_tangent(rotation, detail::vec3_at(numbers, 3)));
}

}  // namespace

const Encoding kL1Mono{"l1-mono",
                       "irradiance, and L1/L0 of the luminance, as hemisphere, directional light and horizon ring",
                       kFields,
                       rotate,
                       true,
                       52,
                       detail::solve_each<solve>,
                       decode,
                       blend};

}  // namespace lumel
