// L2: the nine coefficients of radiance that the master has, evaluated with the bands of the cosine.
// Based on: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps".
#include "encode/encodings.h"

namespace lumel {
namespace {

constexpr auto kS = FieldKind::signed_light;
constexpr Field kFields[] = {{"L0.R", kS}, {"L0.G", kS}, {"L0.B", kS}, {"L1.R", kS}, {"L1.G", kS}, {"L1.B", kS},
                             {"L2.R", kS}, {"L2.G", kS}, {"L2.B", kS}, {"L3.R", kS}, {"L3.G", kS}, {"L3.B", kS},
                             {"L4.R", kS}, {"L4.G", kS}, {"L4.B", kS}, {"L5.R", kS}, {"L5.G", kS}, {"L5.B", kS},
                             {"L6.R", kS}, {"L6.G", kS}, {"L6.B", kS}, {"L7.R", kS}, {"L7.G", kS}, {"L7.B", kS},
                             {"L8.R", kS}, {"L8.G", kS}, {"L8.B", kS}};

Numbers store(const RadianceSh<Vec3, 9>& sh) {
    Numbers out{};
    for (std::size_t i = 0; i < 9; ++i) detail::store_vec3(out, 3 * i, sh.c[i]);
    return out;
}

RadianceSh<Vec3, 9> load(const Numbers& numbers) {
    RadianceSh<Vec3, 9> out;
    for (std::size_t i = 0; i < 9; ++i) out.c[i] = detail::vec3_at(numbers, 3 * i);
    return out;
}

Numbers solve(const TexelLight& light) { return store(light.radiance); }
Vec3 decode(const Numbers& numbers, Vec3 n) { return evaluate(convolve_cosine(load(numbers)), n); }
void rotate_sh(Numbers& numbers, const Rotation& rotation) { numbers = store(rotate(load(numbers), rotation)); }

}  // namespace

const Encoding kL2{"l2",
                   "nine coefficients of radiance per channel",
                   kFields,
                   rotate_sh,
                   false,
                   42,
                   detail::solve_each<solve>,
                   decode,
                   detail::blend_numbers};

}  // namespace lumel
