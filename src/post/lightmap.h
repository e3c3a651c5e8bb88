// One page after post-processing: the master moments with invalid texels filled and charts dilated.
#pragma once

#include <cstdint>
#include <vector>

#include "path/radiance_sums.h"
#include "texel/texel_buffer.h"
#include "texel/texel_surface.h"

namespace lumel {

// Coverage decides whether a texel is baked, never its colour.
enum class Coverage : std::uint8_t { none = 0, dilated = 1, filled = 2, baked = 3 };

struct Lightmap {
    std::uint32_t page = 0, width = 0, height = 0;
    std::vector<std::uint32_t> texel_at;  // width*height: index into the arrays of `texels`, or kNone
    RadianceSums texels;                  // baked texels first (in TexelBuffer order), then dilated ones
    TexelSurface surface;                 // per texel
    std::vector<Coverage> coverage;       // per texel
};

// Fills invalid texels from their valid 3x3 neighbours (repeated until nothing changes), then dilates `rings` rings
// around the charts. Both by coverage.
Lightmap finish_page(const TexelBuffer& buffer, RadianceSums sums, TexelSurface surface, std::uint32_t rings);

}  // namespace lumel
