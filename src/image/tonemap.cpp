#include "image/tonemap.h"

#include <algorithm>
#include <cmath>

#include "image/metrics.h"

namespace lumel {
namespace {

Vec3 rgb_at(const Image& image, std::size_t texel) {
    const float* v = &image.data[texel * image.channels];
    return image.channels >= 3 ? Vec3{v[0], v[1], v[2]} : Vec3{v[0], v[0], v[0]};
}

}  // namespace

float srgb_encode(float linear) {
    const float v = std::clamp(linear, 0.0f, 1.0f);
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

float srgb_decode(float code) {
    const float v = std::clamp(code, 0.0f, 1.0f);
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t srgb8(float linear) {
    // NaN clamps to itself, which has no integer: black.
    return linear > 0.0f ? static_cast<std::uint8_t>(srgb_encode(linear) * 255.0f + 0.5f) : std::uint8_t{0};
}

float auto_exposure(const Image& rgb, std::span<const std::uint8_t> mask, AutoExposure options) {
    std::vector<double> values;
    for (std::size_t i = 0; i < std::size_t{rgb.width} * rgb.height; ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        const float y = luminance(rgb_at(rgb, i));
        if (std::isfinite(y)) values.push_back(static_cast<double>(y));
    }
    // Mostly black pictures (a small lit room in a large atlas) fall back to their brightest part.
    for (const double fraction : {options.fraction, 0.99, 1.0}) {
        const double level = percentile(values, fraction);
        if (level > 0.0) return options.target / static_cast<float>(level);
    }
    return 1.0f;
}

Vec3 tone_curve(Vec3 exposed) {
    constexpr float kStart = 0.8f, kDesaturation = 0.15f;
    const Vec3 color = max(exposed, Vec3{});
    const float peak = max_component(color);
    if (!(peak > kStart)) return color;
    constexpr float kRoom = 1.0f - kStart;
    const float compressed = 1.0f - kRoom * kRoom / (peak + kRoom - kStart);
    const float whiten = 1.0f - 1.0f / (kDesaturation * (peak - compressed) + 1.0f);
    const Vec3 scaled = color * (compressed / peak);
    return scaled * (1.0f - whiten) + Vec3{compressed, compressed, compressed} * whiten;
}

std::vector<std::uint8_t> tonemap(const Image& image, float exposure) {
    const std::size_t count = std::size_t{image.width} * image.height;
    std::vector<std::uint8_t> out(count * 3);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 color = tone_curve(rgb_at(image, i) * exposure);
        for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = srgb8(color[c]);
    }
    return out;
}

}  // namespace lumel
