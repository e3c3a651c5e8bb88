// IEEE half precision in software, for what textures store: rounded to nearest, ties to even; beyond the largest half,
// that one and never infinity.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace lumel {

inline constexpr float kLargestHalf = 65504.0f;

// Of a 16-bit code; infinities and NaN stay such.
constexpr float half_to_float(std::uint16_t code) {
    const std::uint32_t sign = std::uint32_t{code & 0x8000u} << 16, magnitude = code & 0x7FFFu;
    if (magnitude >= 0x7C00u) return std::bit_cast<float>(sign | 0x7F800000u | (magnitude & 0x3FFu) << 13);
    // Below 2^-14 the codes are multiples of 2^-24; above, float has the same exponent and mantissa, shifted.
    if (magnitude < 0x400u) {
        const float value = static_cast<float>(magnitude) * 0x1p-24f;
        return sign != 0 ? -value : value;
    }
    return std::bit_cast<float>(sign | ((magnitude << 13) + 0x38000000u));
}

// The nearest number that a half holds. NaN becomes zero.
inline float round_to_half(float value) {
    const float size = std::fabs(value);
    if (!(size == size)) return 0.0f;
    if (size >= kLargestHalf) return std::copysign(kLargestHalf, value);
    // Adding 2^23 units of the half's last place rounds to that place; below 2^-14 halves are evenly spaced.
    constexpr std::uint32_t kSmallestExponent = 113u << 23;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(size) & 0x7f800000u;
    const auto exponent = bits > kSmallestExponent ? bits : kSmallestExponent;
    const float magic = std::bit_cast<float>(exponent + (13u << 23));
    const float sum = size + magic;
    return std::copysign(sum - magic, value);
}

// The 16-bit code of that number.
inline std::uint16_t half_code(float value) {
    const float rounded = round_to_half(value), size = std::fabs(rounded);
    const std::uint32_t magnitude = size < 0x1p-14f ? static_cast<std::uint32_t>(size * 0x1p24f)
                                                    : (std::bit_cast<std::uint32_t>(size) - 0x38000000u) >> 13;
    return static_cast<std::uint16_t>((std::signbit(rounded) ? 0x8000u : 0u) | magnitude);
}

}  // namespace lumel
