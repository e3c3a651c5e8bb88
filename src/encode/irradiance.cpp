// Plain irradiance: what viewers without normal maps need.
#include "encode/encodings.h"

namespace lumel {
namespace {

constexpr Field kFields[] = {{"I.R", FieldKind::light}, {"I.G", FieldKind::light}, {"I.B", FieldKind::light}};

Numbers solve(const TexelLight& light) {
    Numbers out{};
    detail::store_vec3(out, 0, light.irradiance);
    return out;
}

Vec3 decode(const Numbers& numbers, Vec3 /*normal*/) { return detail::vec3_at(numbers, 0); }

}  // namespace

const Encoding kIrradianceEncoding{"irradiance",
                                   "I about the vertex normal: no direction",
                                   kFields,
                                   nullptr,
                                   true,
                                   0,
                                   detail::solve_each<solve>,
                                   decode,
                                   detail::blend_numbers};

}  // namespace lumel
