// Checks a packing by drawing it, texel by texel, with its own idea of orientations and of what a lookup touches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pack/mask.h"

namespace lumel::test {

struct PackedSpot {
    std::uint32_t page = 0, x = 0, y = 0;
    std::uint8_t orientation = 0;
};

struct PackConflicts {
    std::uint64_t drawn = 0;             // texels
    std::uint64_t overlaps = 0;          // drawn twice
    std::uint64_t outside = 0;           // off the page
    std::vector<std::uint32_t> heights;  // last row drawn + 1, by page
};

// Texel (x, y) of a mask as it lies on the page: transposed, then mirrored in x, then in y.
inline void turn(const ChartMask& mask, std::uint8_t orientation, std::uint32_t& x, std::uint32_t& y) {
    std::uint32_t width = mask.width, height = mask.height;
    if (orientation & 4) {
        std::swap(x, y);
        std::swap(width, height);
    }
    if (orientation & 1) x = width - 1 - x;
    if (orientation & 2) y = height - 1 - y;
}

inline PackConflicts draw_packing(std::span<const ChartMask> masks, std::span<const PackedSpot> spots,
                                  std::uint32_t width) {
    PackConflicts out;
    std::vector<std::vector<std::uint8_t>> pages;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        const PackedSpot& spot = spots[i];
        if (spot.page >= pages.size()) {
            pages.resize(spot.page + 1);
            out.heights.resize(spot.page + 1, 0);
        }
        std::vector<std::uint8_t>& page = pages[spot.page];
        for (std::uint32_t v = 0; v < masks[i].height; ++v)
            for (std::uint32_t u = 0; u < masks[i].width; ++u) {
                if (!masks[i].get(u, v)) continue;
                std::uint32_t x = u, y = v;
                turn(masks[i], spot.orientation, x, y);
                x += spot.x;
                y += spot.y;
                ++out.drawn;
                if (x >= width) {
                    ++out.outside;
                    continue;
                }
                const std::size_t texel = std::size_t{y} * width + x;
                if (texel >= page.size()) page.resize(std::size_t{y + 1} * width * 5 / 4, 0);
                out.overlaps += page[texel];
                page[texel] = 1;
                out.heights[spot.page] = y + 1 > out.heights[spot.page] ? y + 1 : out.heights[spot.page];
            }
    }
    return out;
}

}  // namespace lumel::test
