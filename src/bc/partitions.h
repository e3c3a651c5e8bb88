// How BC6H and BC7 divide the 16 texels of a block among subsets, and at which palette steps they interpolate.
// Based on: Khronos Data Format Specification 1.3, "BPTC compressed texture image formats".
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace lumel {

inline constexpr unsigned kTwoSubsetPartitions = 64;  // BC6H uses the first 32
inline constexpr unsigned kThreeSubsetPartitions = 64;

// Bit i: subset of texel i (row by row).
inline constexpr std::array<std::uint16_t, kTwoSubsetPartitions> kTwoSubsets = {
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80, 0xE800, 0xFFE8,
    0xFF00, 0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310, 0x3100, 0x8CCE, 0x088C, 0x3110,
    0x6666, 0x366C, 0x17E8, 0x0FF0, 0x718E, 0x399C, 0xAAAA, 0xF0F0, 0x5A5A, 0x33CC, 0x3C3C, 0x55AA, 0x9696,
    0xA55A, 0x73CE, 0x13C8, 0x324C, 0x3BDC, 0x6996, 0xC33C, 0x9966, 0x0660, 0x0272, 0x04E4, 0x4E40, 0x2720,
    0xC936, 0x936C, 0x39C6, 0x639C, 0x9336, 0x9CC6, 0x817E, 0xE718, 0xCCF0, 0x0FCC, 0x7744, 0xEE22};
// Bits 2i and 2i+1: subset of texel i.
inline constexpr std::array<std::uint32_t, kThreeSubsetPartitions> kThreeSubsets = {
    0xAA685050, 0x6A5A5040, 0x5A5A4200, 0x5450A0A8, 0xA5A50000, 0xA0A05050, 0x5555A0A0, 0x5A5A5050,
    0xAA550000, 0xAA555500, 0xAAAA5500, 0x90909090, 0x94949494, 0xA4A4A4A4, 0xA9A59450, 0x2A0A4250,
    0xA5945040, 0x0A425054, 0xA5A5A500, 0x55A0A0A0, 0xA8A85454, 0x6A6A4040, 0xA4A45000, 0x1A1A0500,
    0x0050A4A4, 0xAAA59090, 0x14696914, 0x69691400, 0xA08585A0, 0xAA821414, 0x50A4A450, 0x6A5A0200,
    0xA9A58000, 0x5090A0A8, 0xA8A09050, 0x24242424, 0x00AA5500, 0x24924924, 0x24499224, 0x50A50A50,
    0x500AA550, 0xAAAA4444, 0x66660000, 0xA5A0A5A0, 0x50A050A0, 0x69286928, 0x44AAAA44, 0x66666600,
    0xAA444444, 0x54A854A8, 0x95809580, 0x96969600, 0xA85454A8, 0x80959580, 0xAA141414, 0x96960000,
    0xAAAA1414, 0xA05050A0, 0xA0A5A5A0, 0x96000000, 0x40804080, 0xA9A8A9A8, 0xAAAAAA44, 0x2A4A5254};

// The texel of subset 1 (and 2) whose index has its top bit implied as 0. That of subset 0 is texel 0.
inline constexpr std::array<std::uint8_t, kTwoSubsetPartitions> kTwoSubsetAnchors = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2, 2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8, 2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15};
inline constexpr std::array<std::array<std::uint8_t, 2>, kThreeSubsetPartitions> kThreeSubsetAnchors = {{
    {3, 15},  {3, 8},  {15, 8},  {15, 3}, {8, 15},  {3, 15}, {15, 3},  {15, 8}, {8, 15},  {8, 15}, {6, 15},
    {6, 15},  {6, 15}, {5, 15},  {3, 15}, {3, 8},   {3, 15}, {3, 8},   {8, 15}, {15, 3},  {3, 15}, {3, 8},
    {6, 15},  {10, 8}, {5, 3},   {8, 15}, {8, 6},   {6, 10}, {8, 15},  {5, 15}, {15, 10}, {15, 8}, {8, 15},
    {15, 3},  {3, 15}, {5, 10},  {6, 10}, {10, 8},  {8, 9},  {15, 10}, {15, 6}, {3, 15},  {15, 8}, {5, 15},
    {15, 3},  {15, 6}, {15, 6},  {15, 8}, {3, 15},  {15, 3}, {5, 15},  {5, 15}, {5, 15},  {8, 15}, {5, 15},
    {10, 15}, {5, 15}, {10, 15}, {8, 15}, {13, 15}, {15, 3}, {12, 15}, {3, 15}, {3, 8},
}};

// 0 <= partition < 64, 0 <= texel < 16, subsets 1 to 3.
constexpr unsigned subset_of(unsigned subsets, unsigned partition, unsigned texel) {
    if (subsets == 2) return (kTwoSubsets[partition] >> texel) & 1u;
    if (subsets == 3) return (kThreeSubsets[partition] >> (2 * texel)) & 3u;
    return 0;
}

constexpr unsigned anchor_of(unsigned subsets, unsigned partition, unsigned subset) {
    if (subset == 0) return 0;
    return subsets == 2 ? kTwoSubsetAnchors[partition] : kThreeSubsetAnchors[partition][subset - 1];
}

constexpr bool is_anchor(unsigned subsets, unsigned partition, unsigned texel) {
    return texel == anchor_of(subsets, partition, subset_of(subsets, partition, texel));
}

// Weight of the second end point, of 64, for indices of 2 to 4 bits: the rounded even division.
constexpr int palette_weight(unsigned index, unsigned bits) {
    const unsigned steps = (1u << bits) - 1;
    return static_cast<int>((64 * index + steps / 2) / steps);
}

}  // namespace lumel
