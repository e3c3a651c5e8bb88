// The upper five faces of an ambient cube, squares of the normal's components as weights. To compare with.
// Based on: Mitchell, McTaggart and Green 2006, "Shading in Valve's Source Engine". Different here: the faces are the
// least squares over the hemisphere that are exact at n_v, not samples.
#include <algorithm>

#include "encode/encodings.h"
#include "encode/hemisphere_fit.h"

namespace lumel {
namespace {

constexpr auto kS = FieldKind::signed_light;
constexpr Field kFields[] = {{"X.R", kS},  {"X.G", kS},  {"X.B", kS}, {"X-.R", kS}, {"X-.G", kS},
                             {"X-.B", kS}, {"Y.R", kS},  {"Y.G", kS}, {"Y.B", kS},  {"Y-.R", kS},
                             {"Y-.G", kS}, {"Y-.B", kS}, {"Z.R", kS}, {"Z.G", kS},  {"Z.B", kS}};

float squared_if_positive(float v) { return v > 0.0f ? v * v : 0.0f; }

std::array<float, 5> basis(Vec3 n) {
    return {squared_if_positive(n.x), squared_if_positive(-n.x), squared_if_positive(n.y), squared_if_positive(-n.y),
            n.z * n.z};
}

Numbers solve(const TexelLight& light) {
    static const BasisFit<5> fit(basis);
    const std::array<Vec3, 5> v = fit.nearest_exact(light);
    Numbers out{};
    for (std::size_t i = 0; i < 5; ++i) detail::store_vec3(out, 3 * i, v[i]);
    return out;
}

Vec3 decode(const Numbers& numbers, Vec3 n) {
    const std::array<float, 5> b = basis(n);
    Vec3 out;
    for (std::size_t i = 0; i < 5; ++i) out += detail::vec3_at(numbers, 3 * i) * b[i];
    return out;
}

}  // namespace

const Encoding kAmbientCube{
    "ambient-cube", "five faces of a cube", kFields, nullptr, true, 16, detail::solve_each<solve>,
    decode,         detail::blend_numbers};

}  // namespace lumel
