// Plain AHD: ambient and directional colour, direction. To compare with: where neighbours differ in direction, what
// filtering makes of the three is brighter at n_v than either.
// Based on: the "ambient and highlight direction" of Call of Duty as Roughton 2024 describes it.
#include <algorithm>

#include "encode/encodings.h"
#include "encode/lobe_search.h"

namespace lumel {
namespace {

constexpr Field kFields[] = {{"A.R", FieldKind::light}, {"A.G", FieldKind::light}, {"A.B", FieldKind::light},
                             {"D.R", FieldKind::light}, {"D.G", FieldKind::light}, {"D.B", FieldKind::light},
                             {"d.U", FieldKind::unit},  {"d.V", FieldKind::unit}};

Vec3 direction_of(const Numbers& numbers) { return from_hemi_octahedral({numbers[6], numbers[7]}); }

// IrradZ with a weight per channel, as colours.
Numbers from_irradz(const Numbers& irradz) {
    const Vec3 iz = detail::vec3_at(irradz, 0), ambient = iz * detail::vec3_at(irradz, 3);
    Numbers out{};
    out[6] = irradz[6];
    out[7] = irradz[7];
    detail::store_vec3(out, 0, ambient);
    detail::store_vec3(out, 3, (iz - ambient) / std::max(direction_of(out).z, kLowestLobe));
    return out;
}

Numbers to_irradz(const Numbers& numbers) {
    const Vec3 ambient = detail::vec3_at(numbers, 0);
    const Vec3 iz = ambient + detail::vec3_at(numbers, 3) * std::max(direction_of(numbers).z, kLowestLobe);
    Numbers out = numbers;
    detail::store_vec3(out, 0, iz);
    for (std::size_t c = 0; c < 3; ++c) out[3 + c] = iz[c] > 0.0f ? ambient[c] / iz[c] : 1.0f;
    return out;
}

void solve(std::span<const TexelLight> light, std::span<Numbers> out) {
    kIrradZAhdRgb.solve(light, out);
    std::ranges::transform(out, out.begin(), from_irradz);
}

Vec3 decode(const Numbers& numbers, Vec3 n) {
    return detail::vec3_at(numbers, 0) + detail::vec3_at(numbers, 3) * std::max(dot(n, direction_of(numbers)), 0.0f);
}

Numbers blend(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    return from_irradz(kIrradZAhdRgb.blend(to_irradz(a), weight_a, to_irradz(b), weight_b));
}

}  // namespace

const Encoding kAhd{"ahd", "ambient colour, directional colour, direction", kFields, nullptr, true, 27, solve, decode,
                    blend};

}  // namespace lumel
