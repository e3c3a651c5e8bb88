#include "image/colormap.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"

namespace lumel {
namespace {

// hue in turns; saturation and value 0..1.
Vec3 from_hsv(float hue, float saturation, float value) {
    const auto channel = [&](float offset) {
        const float k = std::fmod(hue * 6.0f + offset, 6.0f);
        return value * (1.0f - saturation * std::clamp(std::min(k, 4.0f - k), 0.0f, 1.0f));
    };
    return {channel(5.0f), channel(3.0f), channel(1.0f)};
}

// The top bits of a hash as a number in [0, 1).
float unit_float(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

}  // namespace

Vec3 heat_color(float t) {
    // Cubic Bezier curves per channel: control points chosen by eye.
    t = std::clamp(t, 0.0f, 1.0f);
    const float s = 1.0f - t;
    const Vec3 p0{0.16f, 0.03f, 0.36f}, p1{0.18f, 0.50f, 0.90f}, p2{-0.10f, 0.85f, 0.25f}, p3{1.0f, 0.93f, 0.20f};
    return p0 * (s * s * s) + p1 * (3.0f * s * s * t) + p2 * (3.0f * s * t * t) + p3 * (t * t * t);
}

Vec3 identity_color(std::uint64_t id) {
    // The golden ratio keeps consecutive hues apart; the hash varies saturation and brightness.
    const float hue = static_cast<float>(std::fmod(static_cast<double>(id % 1000003) * 0.6180339887498949, 1.0));
    const std::uint64_t h = mix64(id + 1);
    return from_hsv(hue, 0.45f + 0.4f * unit_float(h), 0.65f + 0.35f * unit_float(mix64(h)));
}

}  // namespace lumel
