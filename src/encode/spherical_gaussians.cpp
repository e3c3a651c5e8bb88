// Five spherical Gaussians of radiance at fixed directions: one about n_v, four around it. To compare with.
// Based on: Neubelt and Pettineo 2015, "Advanced Lighting R&D at Ready At Dawn Studios" (SG lightmaps); Hill 2016, "SG
// irradiance" (the irradiance of a lobe as a smoothed clamped cosine). Different here: amplitudes are the least squares
// of irradiance over the hemisphere that are exact at n_v.
#include <algorithm>
#include <cmath>

#include "encode/encodings.h"
#include "encode/hemisphere_fit.h"

namespace lumel {
namespace {

constexpr auto kS = FieldKind::signed_light;
constexpr Field kFields[] = {{"G0.R", kS}, {"G0.G", kS}, {"G0.B", kS}, {"G1.R", kS}, {"G1.G", kS},
                             {"G1.B", kS}, {"G2.R", kS}, {"G2.G", kS}, {"G2.B", kS}, {"G3.R", kS},
                             {"G3.G", kS}, {"G3.B", kS}, {"G4.R", kS}, {"G4.G", kS}, {"G4.B", kS}};

// Lobes exp(4 (cos - 1)); e^-4 and e^-8 in what follows.
constexpr float kSharpness = 4.0f, kE1 = 0.018315638888734179f, kE2 = 0.00033546262790251184f;
constexpr float kScale = 1.0f + 2.0f * kE2 - 1.0f / kSharpness;
constexpr float kBias = (kE1 - kE2) / kSharpness - kE2;
constexpr float kWidth = 0.49932862f;  // sqrt(1 - kScale)
constexpr float kBend = 0.36f;

// Of unit flux, over its value at the centre of a delta.
float lobe_irradiance(float cosine) {
    const float x = kBend * cosine, rim = kWidth / (4.0f * kBend);
    const float smooth = std::fabs(x) <= rim ? (x + rim) * (x + rim) / kWidth : std::max(cosine, 0.0f);
    return kScale * smooth + kBias;
}

std::array<float, 5> basis(Vec3 n) {
    constexpr float kSide = 0.86602540378443865f, kUp = 0.5f;  // 60 degrees from n_v
    constexpr Vec3 kAxes[5] = {{0, 0, 1}, {kSide, 0, kUp}, {0, kSide, kUp}, {-kSide, 0, kUp}, {0, -kSide, kUp}};
    std::array<float, 5> out;
    for (std::size_t i = 0; i < 5; ++i) out[i] = lobe_irradiance(dot(n, kAxes[i]));
    return out;
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

const Encoding kSphericalGaussians{
    "sg5",  "five spherical Gaussians", kFields, nullptr, true, 65, detail::solve_each<solve>,
    decode, detail::blend_numbers};

}  // namespace lumel
