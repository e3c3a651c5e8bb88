// A mask as the union of few squares, each inside it; they may overlap.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "pack/mask.h"

namespace lumel {

// The sides that squares have, by level. Each is at most twice the one before it, so that four of that cover it.
inline constexpr std::array<std::uint32_t, 20> kSquareSides{1,  2,  3,  4,  5,  6,  7,  8,  10, 12,
                                                            14, 16, 20, 24, 28, 32, 40, 48, 56, 64};

// The level of the largest square that is no larger than this.
constexpr std::uint32_t square_level(std::uint32_t side) {
    std::uint32_t level = 0;
    while (level + 1 < kSquareSides.size() && kSquareSides[level + 1] <= side) ++level;
    return level;
}

struct CoverSquare {
    std::uint32_t level = 0, x = 0, y = 0;
};

// The squares cover the mask's texels, all of them and no others; the largest come first. Not the fewest possible.
// Where `cancelled` says so it returns early, with some texels not covered.
std::vector<CoverSquare> cover(
    const ChartMask& mask, std::uint32_t max_level, const std::function<bool()>& cancelled = [] { return false; });

}  // namespace lumel
