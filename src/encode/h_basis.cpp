// The H-basis of 4 and of 6 functions, orthonormal over the upper hemisphere, for irradiance.
// Based on: Habel and Wimmer 2010, "Efficient Irradiance Normal Mapping". Different here: numbers are the least squares
// that are exact at n_v.
#include "encode/encodings.h"
#include "encode/hemisphere_fit.h"

namespace lumel {
namespace {

constexpr Field kFields[] = {
    {"H0.R", FieldKind::signed_light}, {"H0.G", FieldKind::signed_light}, {"H0.B", FieldKind::signed_light},
    {"H1.R", FieldKind::signed_light}, {"H1.G", FieldKind::signed_light}, {"H1.B", FieldKind::signed_light},
    {"H2.R", FieldKind::signed_light}, {"H2.G", FieldKind::signed_light}, {"H2.B", FieldKind::signed_light},
    {"H3.R", FieldKind::signed_light}, {"H3.G", FieldKind::signed_light}, {"H3.B", FieldKind::signed_light},
    {"H4.R", FieldKind::signed_light}, {"H4.G", FieldKind::signed_light}, {"H4.B", FieldKind::signed_light},
    {"H5.R", FieldKind::signed_light}, {"H5.G", FieldKind::signed_light}, {"H5.B", FieldKind::signed_light}};

template <std::size_t J>
std::array<float, J> basis(Vec3 n) {
    constexpr float k0 = 0.39894228040143268f;  // 1/sqrt(2 pi)
    constexpr float k1 = 0.69098829894267103f;  // sqrt(3/(2 pi))
    constexpr float k2 = 1.5450968080927583f;   // sqrt(15/(2 pi))
    std::array<float, J> out{k0, -k1 * n.y, k1 * (2.0f * n.z - 1.0f), -k1 * n.x};
    if constexpr (J == 6) {
        out[4] = k2 * n.x * n.y;
        out[5] = 0.5f * k2 * (n.x * n.x - n.y * n.y);
    }
    return out;
}

template <std::size_t J>
Numbers solve(const TexelLight& light) {
    static const BasisFit<J> fit(basis<J>);
    const std::array<Vec3, J> v = fit.nearest_exact(light);
    Numbers out{};
    for (std::size_t i = 0; i < J; ++i) detail::store_vec3(out, 3 * i, v[i]);
    return out;
}

template <std::size_t J>
Vec3 decode(const Numbers& numbers, Vec3 n) {
    const std::array<float, J> b = basis<J>(n);
    Vec3 out;
    for (std::size_t i = 0; i < J; ++i) out += detail::vec3_at(numbers, 3 * i) * b[i];
    return out;
}

}  // namespace

const Encoding kH4{"h4",
                   "4 functions of the H-basis",
                   std::span(kFields).first(12),
                   nullptr,
                   true,
                   16,
                   detail::solve_each<solve<4>>,
                   decode<4>,
                   detail::blend_numbers};
const Encoding kH6{"h6",      "6 functions of the H-basis", kFields, nullptr, true, 28, detail::solve_each<solve<6>>,
                   decode<6>, detail::blend_numbers};

}  // namespace lumel
