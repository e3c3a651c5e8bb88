// IEEE half precision in software, for what textures store: rounded to nearest, ties to even; beyond the largest half,
// that one and never infinity.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace lumel {

inline constexpr float kLargestHalf = 65504.0f;

// The nearest number that a half holds. NaN becomes zero.
inline float round_to_half(float value) {
    const float size = std::fabs(value);
    if (!(size == size)) return 0.0f;
    if (size >= kLargestHalf) return std::copysign(kLargestHalf, value);
    // Adding 1.5 * 2^13 units of the half's last place rounds to that place; below 2^-14 halves are evenly spaced.
    constexpr std::uint32_t kSmallestExponent = 113u << 23;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(size) & 0x7f800000u;
    const auto exponent = bits > kSmallestExponent ? bits : kSmallestExponent;
    const float magic = std::bit_cast<float>(exponent + (13u << 23));
    const float sum = size + magic;
    return std::copysign(sum - magic, value);
}

}  // namespace lumel
