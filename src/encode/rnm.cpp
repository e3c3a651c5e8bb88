// Radiosity normal maps: irradiance in the three directions of the Half-Life 2 basis. To compare with.
// Based on: McTaggart 2004, "Half-Life 2 / Valve Source Shading" (basis; weights as in Green 2007, "Efficient
// Self-Shadowed Radiosity Normal Mapping"). Different here: the three are the least squares that are exact at n_v.
#include "encode/encodings.h"
#include "encode/hemisphere_fit.h"

namespace lumel {
namespace {

constexpr auto kS = FieldKind::signed_light;
constexpr Field kFields[] = {{"N0.R", kS}, {"N0.G", kS}, {"N0.B", kS}, {"N1.R", kS}, {"N1.G", kS},
                             {"N1.B", kS}, {"N2.R", kS}, {"N2.G", kS}, {"N2.B", kS}};

std::array<float, 3> basis(Vec3 n) {
    constexpr float kSqrt23 = 0.81649658092772603f, kSqrt12 = 0.70710678118654752f;
    constexpr float kSqrt16 = 0.40824829046386302f, kSqrt13 = 0.57735026918962576f;
    constexpr Vec3 kAxes[3] = {{kSqrt23, 0, kSqrt13}, {-kSqrt16, kSqrt12, kSqrt13}, {-kSqrt16, -kSqrt12, kSqrt13}};
    std::array<float, 3> out;
    float sum = 0.0f;
    for (std::size_t i = 0; i < 3; ++i) {
        const float c = dot(n, kAxes[i]);
        out[i] = c > 0.0f ? c * c : 0.0f;
        sum += out[i];
    }
    for (float& w : out) w /= sum;  // every direction of the hemisphere is less than 90 degrees from one of the axes
    return out;
}

Numbers solve(const TexelLight& light) {
    static const BasisFit<3> fit(basis);
    const std::array<Vec3, 3> v = fit.nearest_exact(light);
    Numbers out{};
    for (std::size_t i = 0; i < 3; ++i) detail::store_vec3(out, 3 * i, v[i]);
    return out;
}

Vec3 decode(const Numbers& numbers, Vec3 n) {
    const std::array<float, 3> b = basis(n);
    return detail::vec3_at(numbers, 0) * b[0] + detail::vec3_at(numbers, 3) * b[1] + detail::vec3_at(numbers, 6) * b[2];
}

}  // namespace

const Encoding kRnm{"rnm",
                    "irradiance in three directions",
                    kFields,
                    nullptr,
                    true,
                    32,
                    detail::solve_each<solve>,
                    decode,
                    detail::blend_numbers};

}  // namespace lumel
