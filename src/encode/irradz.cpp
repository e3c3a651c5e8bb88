// IrradZ-AHD and IrradZ-HHD: I_z in colour, the ambient weight (one, or one per channel), the light's direction.
// I = I_z (w a(n) + (1 - w) max(n.d, 0)/d_z) is I_z at n_v whatever w and d, so that filtering them cannot overshoot.
// Based on: Roughton 2024, "Hemispherical Lighting Insights".
#include <algorithm>
#include <array>

#include "encode/encodings.h"
#include "encode/hhd.h"
#include "encode/lobe_search.h"

namespace lumel {
namespace {

constexpr Field kFields[] = {{"I.R", FieldKind::light}, {"I.G", FieldKind::light}, {"I.B", FieldKind::light},
                             {"w", FieldKind::unit},    {"d.U", FieldKind::unit},  {"d.V", FieldKind::unit}};
constexpr Field kFieldsRgb[] = {{"I.R", FieldKind::light}, {"I.G", FieldKind::light}, {"I.B", FieldKind::light},
                                {"w.R", FieldKind::unit},  {"w.G", FieldKind::unit},  {"w.B", FieldKind::unit},
                                {"d.U", FieldKind::unit},  {"d.V", FieldKind::unit}};

enum class Weights : std::uint8_t { luminance, rgb };
constexpr std::size_t weight_count(Weights weights) { return weights == Weights::rgb ? 3 : 1; }

using Target = std::array<float, 9>;

// I/I_z in irradiance coefficients; zero where it is dark.
Target target_of(const RadianceSh<float, 9>& radiance, float iz) {
    Target out = convolve_cosine(radiance).c;
    const float scale = iz > 0.0f ? 1.0f / iz : 0.0f;
    for (float& v : out) v *= scale;
    return out;
}

RadianceSh<float, 9> channel(const RadianceSh<Vec3, 9>& sh, std::size_t c) {
    RadianceSh<float, 9> out;
    for (std::size_t i = 0; i < 9; ++i) out.c[i] = sh.c[i][c];
    return out;
}

Numbers store(const TexelLight& light, Vec3 direction, float weight, AmbientLobe ambient, Weights weights) {
    Numbers out{};
    detail::store_vec3(out, 0, light.irradiance);
    out[3] = weight;
    if (weights == Weights::rgb) {
        const LobePair pair(direction, ambient, kHemisphereGram);
        for (std::size_t c = 0; c < 3; ++c) {
            const float iz = light.irradiance[c];
            out[3 + c] = iz > 0.0f ? pair.ambient_weight(target_of(channel(light.radiance, c), iz)) : 1.0f;
        }
    }
    const Vec2 uv = to_hemi_octahedral(direction);
    out[3 + weight_count(weights)] = uv.x;
    out[4 + weight_count(weights)] = uv.y;
    return out;
}

template <AmbientLobe kAmbient, Weights kWeights>
void solve_searched(std::span<const TexelLight> light, std::span<Numbers> out) {
    constexpr std::size_t kBatch = 64;
    std::array<Target, kBatch> targets;
    std::array<Vec3, kBatch> start;
    std::array<LobeFit, kBatch> fits;
    for (std::size_t first = 0; first < light.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, light.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const RadianceSh<float, 9> l = luminance(light[first + i].radiance);
            targets[i] = target_of(l, luminance(light[first + i].irradiance));
            start[i] = optimal_linear_direction(l, Vec3{0, 0, 1});
        }
        search_lobes(std::span(targets).first(count), std::span(start).first(count), kAmbient, kHemisphereGram,
                     std::span(fits).first(count));
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = store(light[first + i], fits[i].direction, fits[i].ambient_weight, kAmbient, kWeights);
    }
}

// HHD from the luminance's moments.
template <Weights kWeights>
Numbers solve_closed(const TexelLight& light) {
    const RadianceSh<float, 9> l = luminance(light.radiance);
    const Hhd hhd = solve_hhd(light_moments({l.c[0], l.c[1], l.c[2], l.c[3]}));
    const Vec3 direction = lifted(hhd.direction);
    float weight = hhd.iz > 0.0f ? hhd.ambient / hhd.iz : 1.0f;
    if (hhd.direction.z < kLowestLobe) {  // light that the numbers cannot hold: its nearest, from where they can
        const float iz = luminance(light.irradiance);
        weight = LobePair(direction, AmbientLobe::hemisphere, kHemisphereGram).ambient_weight(target_of(l, iz));
    }
    return store(light, direction, weight, AmbientLobe::hemisphere, kWeights);
}

template <Weights kWeights>
Vec3 direction_of(const Numbers& numbers) {
    Vec3 d = from_hemi_octahedral({numbers[3 + weight_count(kWeights)], numbers[4 + weight_count(kWeights)]});
    d.z = std::max(d.z, kLowestLobe);  // rounding and filtering may have left it lower; I at n_v stays I_z
    return d;
}

template <Weights kWeights>
Vec3 weights_of(const Numbers& numbers) {
    return kWeights == Weights::rgb ? detail::vec3_at(numbers, 3) : Vec3{1, 1, 1} * numbers[3];
}

template <AmbientLobe kAmbient, Weights kWeights>
Vec3 decode(const Numbers& numbers, Vec3 n) {
    const Vec3 d = direction_of<kWeights>(numbers), w = weights_of<kWeights>(numbers);
    const float a = kAmbient == AmbientLobe::uniform ? 1.0f : 0.5f * (1.0f + n.z);
    const float lobe = std::max(dot(n, d), 0.0f) / d.z;
    return detail::vec3_at(numbers, 0) * (w * (a - lobe) + Vec3{1, 1, 1} * lobe);
}

// The light that the numbers stand for.
template <AmbientLobe kAmbient, Weights kWeights>
TexelLight light_of(const Numbers& numbers) {
    constexpr float kTwoSqrtPi = 3.5449077018110321f;
    const Vec3 iz = detail::vec3_at(numbers, 0), w = weights_of<kWeights>(numbers);
    const Vec3 d = direction_of<kWeights>(numbers), ambient = iz * w;
    TexelLight out{directional_light((iz - ambient) / d.z, d), {}, iz};
    if (kAmbient == AmbientLobe::uniform) {
        out.radiance.c[0] += ambient * kTwoSqrtPi;
    } else {
        const RadianceSh<Vec3, 9> hemisphere = hemisphere_light(ambient, Vec3{0, 0, 1});
        for (std::size_t i = 0; i < 9; ++i) out.radiance.c[i] += hemisphere.c[i];
    }
    return out;
}

template <AmbientLobe kAmbient, Weights kWeights>
Numbers blend_sets(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    const TexelLight light =
        blend(light_of<kAmbient, kWeights>(a), weight_a, light_of<kAmbient, kWeights>(b), weight_b);
    if (kAmbient == AmbientLobe::hemisphere) return solve_closed<kWeights>(light);
    Numbers out;
    solve_searched<kAmbient, kWeights>(std::span(&light, 1), std::span(&out, 1));
    return out;
}

constexpr auto kU = AmbientLobe::uniform, kH = AmbientLobe::hemisphere;
constexpr auto kLum = Weights::luminance, kRgb = Weights::rgb;

}  // namespace

const Encoding kIrradZAhd{"irradz-ahd",
                          "irradiance, ambient weight, direction: uniform ambient light",
                          kFields,
                          nullptr,
                          true,
                          34,
                          solve_searched<kU, kLum>,
                          decode<kU, kLum>,
                          blend_sets<kU, kLum>};
const Encoding kIrradZHhd{"irradz-hhd",
                          "irradiance, ambient weight, direction: hemisphere of ambient light",
                          kFields,
                          nullptr,
                          true,
                          36,
                          solve_searched<kH, kLum>,
                          decode<kH, kLum>,
                          blend_sets<kH, kLum>};
const Encoding kIrradZHhdClosed{"irradz-hhd-closed",
                                "as irradz-hhd, solved in closed form from linear SH",
                                kFields,
                                nullptr,
                                true,
                                36,
                                detail::solve_each<solve_closed<kLum>>,
                                decode<kH, kLum>,
                                blend_sets<kH, kLum>};
const Encoding kIrradZAhdRgb{"irradz-ahd-rgb",
                             "as irradz-ahd, with an ambient weight for each channel",
                             kFieldsRgb,
                             nullptr,
                             true,
                             38,
                             solve_searched<kU, kRgb>,
                             decode<kU, kRgb>,
                             blend_sets<kU, kRgb>};
const Encoding kIrradZHhdRgb{"irradz-hhd-rgb",
                             "as irradz-hhd, with an ambient weight for each channel",
                             kFieldsRgb,
                             nullptr,
                             true,
                             40,
                             solve_searched<kH, kRgb>,
                             decode<kH, kRgb>,
                             blend_sets<kH, kRgb>};

}  // namespace lumel
