// HLSH: linear irradiance over the hemisphere in the basis z, 1 - z, x, y, of which the first number is I_z.
// Based on: Roughton 2024, "Hemispherical Lighting Insights".
#include "encode/encodings.h"
#include "encode/hemisphere_fit.h"

namespace lumel {
namespace {

constexpr Field kFields[] = {
    {"I.R", FieldKind::light},         {"I.G", FieldKind::light},         {"I.B", FieldKind::light},
    {"A.R", FieldKind::signed_light},  {"A.G", FieldKind::signed_light},  {"A.B", FieldKind::signed_light},
    {"Cx.R", FieldKind::signed_light}, {"Cx.G", FieldKind::signed_light}, {"Cx.B", FieldKind::signed_light},
    {"Cy.R", FieldKind::signed_light}, {"Cy.G", FieldKind::signed_light}, {"Cy.B", FieldKind::signed_light}};

std::array<float, 4> basis(Vec3 n) { return {n.z, 1.0f - n.z, n.x, n.y}; }

Numbers solve(const TexelLight& light) {
    static const BasisFit<4> fit(basis);
    const std::array<Vec3, 4> v = fit.nearest_exact(light);
    Numbers out{};
    for (std::size_t i = 0; i < 4; ++i) detail::store_vec3(out, 3 * i, v[i]);
    return out;
}

Vec3 decode(const Numbers& numbers, Vec3 n) {
    const std::array<float, 4> b = basis(n);
    Vec3 out;
    for (std::size_t i = 0; i < 4; ++i) out += detail::vec3_at(numbers, 3 * i) * b[i];
    return out;
}

}  // namespace

const Encoding kHlsh{"hlsh",
                     "irradiance linear over the hemisphere, exact at n_v",
                     kFields,
                     nullptr,
                     true,
                     13,
                     detail::solve_each<solve>,
                     decode,
                     detail::blend_numbers};

}  // namespace lumel
