// IEEE half floats as 16-bit codes.
#pragma once

#include <bit>
#include <cstdint>

namespace lumel {

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

}  // namespace lumel
