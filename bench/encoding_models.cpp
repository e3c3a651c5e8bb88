#include "encoding_models.h"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "encode/encodings.h"
#include "encode/hhd.h"
#include "encode/l1.h"
#include "encoding_lobes.h"

namespace lumel::bench {
namespace {

Decoded decoded_by(const Encoding& encoding, const TexelLight& light) {
    Numbers numbers{};
    encoding.solve(std::span(&light, 1), std::span(&numbers, 1));
    return [&encoding, numbers](Vec3 n) { return encoding.decode(numbers, n); };
}
EncodingModel encoded(const Encoding& encoding) {
    return [&encoding](const EncodingCase& c) { return decoded_by(encoding, c.light); };
}
// As from a stored master: nine coefficients and the irradiance about n_v.
EncodingModel from_master(const Encoding& encoding) {
    return [&encoding](const EncodingCase& c) {
        TexelLight light = c.light;
        light.fit = fit_irradiance(light.radiance);
        return decoded_by(encoding, light);
    };
}

template <std::size_t J>
EncodingModel nearest(std::array<float, J> (*basis)(Vec3)) {
    return [basis, fit = std::make_shared<BasisFit<J>>(basis)](const EncodingCase& c) -> Decoded {
        return [basis, v = fit->nearest(c.light.fit)](Vec3 n) {
            const std::array<float, J> b = basis(n);
            Vec3 out;
            for (std::size_t j = 0; j < J; ++j) out += v[j] * b[j];
            return out;
        };
    };
}

std::array<float, 4> linear_basis(Vec3 n) { return {1, n.x, n.y, n.z}; }
std::array<float, 6> h6_basis(Vec3 n) { return {1, n.x, n.y, n.z, n.x * n.y, n.x * n.x - n.y * n.y}; }
std::array<float, 5> cube_basis(Vec3 n) {
    const auto square = [](float v) { return v > 0 ? v * v : 0; };
    return {square(n.x), square(-n.x), square(n.y), square(-n.y), square(n.z)};
}

Decoded linear_exact_at_normal(const EncodingCase& c) {
    return [l1 = encode_l1(linear_part(c.light.radiance))](Vec3 n) {
        Vec3 out;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 r1 = l1.l1n[i] * l1.l0[i];
            out[i] = l1.l0[i] * (1 - n.z) + 2 * (n.x * r1.x + n.y * r1.y) + 4 * n.z * r1.z;
        }
        return out;
    };
}

Decoded hhd_without_ring(const RadianceSh<Vec3, 4>& radiance) {
    std::array<Hhd, 3> hhd;
    for (std::size_t c = 0; c < 3; ++c) hhd[c] = solve_hhd(light_moments(radiance, c));
    return [hhd](Vec3 n) { return Vec3{evaluate(hhd[0], n), evaluate(hhd[1], n), evaluate(hhd[2], n)}; };
}

// Radiance fitted over the hemisphere, then convolved: not to be used.
Decoded radiance_fitted(const EncodingCase& c) {
    std::vector<double> gram(16), right(12);
    for (std::size_t i = 0; i < 4; ++i) {
        std::array<float, 9> unit{};
        unit[i] = 1;
        const std::array<float, 9> column = multiply(kHemisphereGram, unit);
        for (std::size_t j = 0; j < 4; ++j) gram[4 * j + i] = static_cast<double>(column[j]);
        for (std::size_t k = 0; k < 3; ++k) right[3 * i + k] = static_cast<double>(c.light.radiance.c[i][k]);
    }
    solve_positive_definite(std::move(gram), 4, right, 3);
    RadianceSh<Vec3, 4> radiance;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 3; ++k) radiance.c[i][k] = static_cast<float>(right[3 * i + k]);
    return [sh = convolve_cosine(radiance)](Vec3 n) { return evaluate(sh, n); };
}

Decoded cube_sampled(const EncodingCase& c) {
    const std::vector<Vec3> axes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    return [faces = irradiance(c.environment, axes)](Vec3 n) {
        const std::array<float, 5> b = cube_basis(n);
        Vec3 out;
        for (std::size_t j = 0; j < 5; ++j)
            for (std::size_t i = 0; i < 3; ++i) out[i] += b[j] * static_cast<float>(faces[j][i]);
        return out;
    };
}

constexpr auto kAhdLobe = AmbientLobe::uniform, kHhdLobe = AmbientLobe::hemisphere;

}  // namespace

std::vector<EncodingRow> texel_rows() {
    return {
        {"scalar I_z", encoded(kIrradianceEncoding)},
        {"L1 moments, linear", encoded(kL1Linear)},
        {"L1 moments, linear, I_z fixed", linear_exact_at_normal},
        {"L1 moments, Hazel", encoded(kL1Hazel)},
        {"L1 moments, HHD", [](const EncodingCase& c) { return hhd_without_ring(linear_part(c.light.radiance)); }},
        {"L1 moments, HHD+ring", encoded(kL1Hhd)},
        {"H4", nearest<4>(linear_basis)},
        {"HLSH", encoded(kHlsh)},
        {"L1 radiance over the hemisphere", radiance_fitted},
        {"ambient cube, sampled", cube_sampled},
        {"ambient cube, fitted", nearest<5>(cube_basis)},
        {"H6", nearest<6>(h6_basis)},
        {"ZH3 hallucinated", encoded(kZh3Hallucinated)},
        {"ZH3 stored", encoded(kZh3)},
        {"L2 moments", encoded(kL2)},
        {"L2 fitted",
         [](const EncodingCase& c) -> Decoded { return [f = c.light.fit](Vec3 n) { return evaluate(f, n); }; }},
        {"AHD sphere Gram, linear direction", lobes(kAhdLobe, kIdentityMatrix, LobeDirection::linear)},
        {"AHD hemisphere Gram, linear direction", lobes(kAhdLobe, kHemisphereGram, LobeDirection::linear)},
        {"AHD hemisphere Gram, search", nested_lobes(kAhdLobe, kHemisphereGram)},
        {"AHD exact lobes, search", exact_lobes(kAhdLobe, LobeWeights::luminance)},
        {"AHD search, weight per channel", exact_lobes(kAhdLobe, LobeWeights::rgb)},
        {"HHD sphere Gram, linear direction", lobes(kHhdLobe, kIdentityMatrix, LobeDirection::linear)},
        {"HHD hemisphere Gram, linear direction", lobes(kHhdLobe, kHemisphereGram, LobeDirection::linear)},
        {"HHD hemisphere Gram, search", nested_lobes(kHhdLobe, kHemisphereGram)},
        {"HHD exact lobes, search", exact_lobes(kHhdLobe, LobeWeights::luminance)},
        {"HHD search, weight per channel", exact_lobes(kHhdLobe, LobeWeights::rgb)},
        {"HHD closed form", hhd_closed},
        // Not in the other program.
        {"IrradZ-AHD", encoded(kIrradZAhd)},
        {"IrradZ-HHD", encoded(kIrradZHhd)},
        {"IrradZ-AHD, weight per channel", encoded(kIrradZAhdRgb)},
        {"IrradZ-HHD, weight per channel", encoded(kIrradZHhdRgb)},
        {"IrradZ-HHD in closed form", encoded(kIrradZHhdClosed)},
        {"L1 fitted, linear", encoded(kL1LinearFit)},
        {"L1 fitted, Hazel", encoded(kL1HazelFit)},
        {"L1 monochrome", encoded(kL1Mono)},
        {"H4, I_z fixed", encoded(kH4)},
        {"H6, I_z fixed", encoded(kH6)},
        {"AHD plain", encoded(kAhd)},
        {"ambient cube, I_z fixed", encoded(kAmbientCube)},
        {"RNM, I_z fixed", encoded(kRnm)},
        {"5 spherical Gaussians, I_z fixed", encoded(kSphericalGaussians)},
        {"HLSH from the master", from_master(kHlsh)},
        {"H6 from the master, I_z fixed", from_master(kH6)},
        {"L1 fitted, Hazel, from the master", from_master(kL1HazelFit)},
        {"L2 fitted, from the master",
         [](const EncodingCase& c) -> Decoded {
             return [f = fit_irradiance(c.light.radiance)](Vec3 n) { return evaluate(f, n); };
         }},
    };
}

std::vector<EncodingRow> probe_rows() {
    const Vec3 up{0, 0, 1};
    return {
        {"L2, no occlusion",
         [](const EncodingCase& c) -> Decoded {
             return [f = convolve_cosine(c.light.radiance)](Vec3 n) { return evaluate(f, n); };
         }},
        {"L2 x Gram (9 coeff.)",
         [](const EncodingCase& c) -> Decoded {
             const RadianceSh<Vec3, 9> seen{multiply(kHemisphereGram, c.light.radiance.c)};
             return [f = convolve_cosine(seen)](Vec3 n) { return evaluate(f, n); };
         }},
        {"quadratic to linear",
         [up](const EncodingCase& c) -> Decoded {
             return [f = convolve_cosine(multiply_hemisphere_linear(c.light.radiance, up))](Vec3 n) {
                 return evaluate(f, n);
             };
         }},
        {"HLSH",
         [up](const EncodingCase& c) -> Decoded {
             return [h = multiply_cone(c.light.radiance, up, 0.0f)](Vec3 n) {
                 return h.ambient + detail::row_times(n, h.linear);
             };
         }},
        {"quadratic to linear to HHD",
         [up](const EncodingCase& c) { return hhd_without_ring(multiply_hemisphere_linear(c.light.radiance, up)); }},
    };
}

std::vector<EncodingRow> sphere_rows() {
    return {
        {"AHD sphere Gram, linear direction", lobes(kAhdLobe, kIdentityMatrix, LobeDirection::linear)},
        {"AHD sphere Gram, search", nested_lobes(kAhdLobe, kIdentityMatrix)},
        {"AHD hemisphere Gram, linear direction", lobes(kAhdLobe, kHemisphereGram, LobeDirection::linear)},
        {"AHD hemisphere Gram, search", nested_lobes(kAhdLobe, kHemisphereGram)},
        {"HHD sphere Gram, linear direction", lobes(kHhdLobe, kIdentityMatrix, LobeDirection::linear)},
        {"HHD sphere Gram, search", nested_lobes(kHhdLobe, kIdentityMatrix)},
        {"HHD hemisphere Gram, linear direction", lobes(kHhdLobe, kHemisphereGram, LobeDirection::linear)},
        {"HHD hemisphere Gram, search", nested_lobes(kHhdLobe, kHemisphereGram)},
        {"AHD hemisphere Gram, Lumel's search", lobes(kAhdLobe, kHemisphereGram, LobeDirection::searched)},
        {"HHD hemisphere Gram, Lumel's search", lobes(kHhdLobe, kHemisphereGram, LobeDirection::searched)},
    };
}

}  // namespace lumel::bench
