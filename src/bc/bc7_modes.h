// The eight block layouts of BC7.
// Based on: Khronos Data Format Specification 1.3, table "BC7 mode-specific parameters".
#pragma once

#include <array>
#include <cstdint>

namespace lumel {

// What the bits below the end points' own are: none, one for each end point, one for both of a subset.
enum class Bc7LowBit : std::uint8_t { none, each, shared };

struct Bc7Mode {
    std::uint8_t subsets, partition_bits, rotation_bits, selector_bits;
    std::uint8_t colour_bits, alpha_bits;  // of an end point, without the low bit
    Bc7LowBit low_bit;
    std::uint8_t index_bits, second_index_bits;
};

inline constexpr std::array<Bc7Mode, 8> kBc7ModeTable = {{
    {3, 4, 0, 0, 4, 0, Bc7LowBit::each, 3, 0},
    {2, 6, 0, 0, 6, 0, Bc7LowBit::shared, 3, 0},
    {3, 6, 0, 0, 5, 0, Bc7LowBit::none, 2, 0},
    {2, 6, 0, 0, 7, 0, Bc7LowBit::each, 2, 0},
    {1, 0, 2, 1, 5, 6, Bc7LowBit::none, 2, 3},
    {1, 0, 2, 0, 7, 8, Bc7LowBit::none, 2, 2},
    {1, 0, 0, 0, 7, 7, Bc7LowBit::each, 4, 0},
    {2, 6, 0, 0, 5, 5, Bc7LowBit::each, 2, 0},
}};

}  // namespace lumel
