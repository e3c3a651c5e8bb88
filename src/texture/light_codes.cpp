#include "texture/light_codes.h"

#include <algorithm>
#include <cmath>

namespace lumel {
namespace {

// Not negative, no NaN.
Vec3 cleaned(Vec3 light, float largest) {
    const auto clean = [&](float v) { return v > 0.0f ? std::min(v, largest) : 0.0f; };
    return {clean(light.x), clean(light.y), clean(light.z)};
}

std::uint8_t to_byte(float unit) {
    return static_cast<std::uint8_t>(std::floor(std::clamp(unit, 0.0f, 1.0f) * 255.0f + 0.5f));
}
constexpr float from_byte(std::uint8_t code) { return static_cast<float>(code) / 255.0f; }

// Rows: what X', Y and XYZ' are of R, G and B; scaled so that X'/XYZ' and Y/XYZ' of any colour stay below 1.
constexpr std::array<std::array<double, 3>, 3> kToLuv{
    {{0.2209, 0.1138, 0.0102}, {0.3390, 0.6780, 0.1130}, {0.4184, 0.7319, 0.2969}}};
constexpr std::array<std::array<double, 3>, 3> kFromLuv{
    {{6.0013654, -1.3320037, 0.3007831}, {-2.7007574, 3.1029433, -1.0881942}, {-1.7995519, -5.7720911, 5.6268162}}};

}  // namespace

std::uint32_t encode_rgb9e5(Vec3 light) {
    constexpr int kBias = 15, kMantissa = 9, kLargestExponent = 31;
    const Vec3 v = cleaned(light, kLargestRgb9e5);
    const float brightest = max_component(v);
    int exponent = 0;
    std::frexp(brightest, &exponent);  // brightest < 2^exponent
    exponent = brightest > 0.0f ? std::max(exponent, -kBias) : -kBias;
    // Rounding may reach 2^9, which is one exponent more.
    if (std::floor(std::ldexp(brightest, kMantissa - exponent) + 0.5f) > 511.0f) ++exponent;
    exponent = std::min(exponent, kLargestExponent - kBias);
    const auto mantissa = [&](float x) {
        return std::min(511u, static_cast<std::uint32_t>(std::ldexp(x, kMantissa - exponent) + 0.5f));
    };
    return mantissa(v.x) | mantissa(v.y) << 9 | mantissa(v.z) << 18 |
           static_cast<std::uint32_t>(exponent + kBias) << 27;
}

Vec3 decode_rgb9e5(std::uint32_t code) {
    const float scale = std::ldexp(1.0f, static_cast<int>(code >> 27) - 15 - 9);
    return Vec3{static_cast<float>(code & 511u), static_cast<float>(code >> 9 & 511u),
                static_cast<float>(code >> 18 & 511u)} *
           scale;
}

PixelBytes encode_rgbm(Vec3 light) {
    const Vec3 v = cleaned(light, 1.0f);
    const float brightest = max_component(v);
    if (!(brightest > 0.0f)) return {0, 0, 0, 0};
    const auto m = static_cast<std::uint8_t>(std::max(1.0f, std::ceil(brightest * 255.0f)));
    const Vec3 rgb = v / from_byte(m);
    return {to_byte(rgb.x), to_byte(rgb.y), to_byte(rgb.z), m};
}

Vec3 decode_rgbm(PixelBytes code) {
    return Vec3{from_byte(code[0]), from_byte(code[1]), from_byte(code[2])} * from_byte(code[3]);
}

PixelBytes encode_rgbd(Vec3 light) {
    const Vec3 v = cleaned(light, kLargestRgbd);
    const float brightest = std::max(max_component(v), 1.0f);
    const auto d = static_cast<std::uint8_t>(std::max(1.0f, std::floor(255.0f / brightest)));
    const auto coded = [&](float x) { return to_byte(std::pow(x * from_byte(d), 1.0f / 2.2f)); };
    return {coded(v.x), coded(v.y), coded(v.z), d};
}

Vec3 decode_rgbd(PixelBytes code) {
    const auto linear = [&](std::uint8_t c) { return std::pow(from_byte(c), 2.2f); };
    return code[3] == 0 ? Vec3{} : Vec3{linear(code[0]), linear(code[1]), linear(code[2])} / from_byte(code[3]);
}

PixelBytes encode_logluv(Vec3 light) {
    const Vec3 v = cleaned(light, 1e18f);
    std::array<double, 3> x{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) x[r] += kToLuv[r][c] * static_cast<double>(v[c]);
    if (!(x[2] > 0.0)) return {0, 0, 0, 0};
    const double log = std::clamp(2.0 * std::log2(x[1]) + 127.0, 1.0 / 255.0, 255.0), whole = std::floor(log);
    return {to_byte(static_cast<float>(x[0] / x[2])), to_byte(static_cast<float>(x[1] / x[2])),
            static_cast<std::uint8_t>(whole), to_byte(static_cast<float>(log - whole))};
}

Vec3 decode_logluv(PixelBytes code) {
    if (code[1] == 0) return {};
    const double y = std::exp2((code[2] + code[3] / 255.0 - 127.0) / 2.0);
    const double sum = y / from_byte(code[1]), x = sum * static_cast<double>(from_byte(code[0]));
    Vec3 out;
    for (std::size_t c = 0; c < 3; ++c)
        out[c] = static_cast<float>(std::max(0.0, kFromLuv[c][0] * x + kFromLuv[c][1] * y + kFromLuv[c][2] * sum));
    return out;
}

PixelBytes encode_rgbe(Vec3 light) {
    const Vec3 v = cleaned(light, 1e37f);
    const float brightest = max_component(v);
    if (!(brightest > 1e-37f)) return {0, 0, 0, 0};
    int exponent = 0;
    std::frexp(brightest, &exponent);
    if (std::floor(std::ldexp(brightest, 8 - exponent) + 0.5f) > 255.0f) ++exponent;
    const auto mantissa = [&](float x) { return static_cast<std::uint8_t>(std::ldexp(x, 8 - exponent) + 0.5f); };
    return {mantissa(v.x), mantissa(v.y), mantissa(v.z), static_cast<std::uint8_t>(exponent + 128)};
}

Vec3 decode_rgbe(PixelBytes code) {
    if (code[3] == 0) return {};
    return Vec3{static_cast<float>(code[0]), static_cast<float>(code[1]), static_cast<float>(code[2])} *
           std::ldexp(1.0f, int{code[3]} - 136);
}

}  // namespace lumel
