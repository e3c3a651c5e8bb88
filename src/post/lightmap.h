// One page after post-processing: the master moments with invalid texels filled and charts dilated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/context.h"
#include "lumel/page.h"
#include "lumel/result.h"
#include "path/radiance_sums.h"
#include "texel/texel_buffer.h"
#include "texel/texel_surface.h"

namespace lumel {

struct Lightmap {
    std::uint32_t page = 0, mip = 0, width = 0, height = 0;
    std::vector<std::uint32_t> texel_at;  // width*height: index into the arrays of `texels`, or kNone
    RadianceSums texels;                  // baked texels first (in TexelBuffer order), then dilated ones
    TexelSurface surface;                 // per texel
    std::vector<Vec3> normal;             // per texel: the vertex normal, about which its irradiance is
    std::vector<Coverage> coverage;       // per texel
    std::vector<std::uint32_t> chart;     // per texel: whose light it is, as in TexelBuffer
    // Per texel that was rasterised: 1 where mips should not average it (path/mip_leaks.h). Empty: average all.
    std::vector<std::uint8_t> leaks;
};

// At most how many texels the page has once `rings` rings surround its charts: for reserving before they are traced.
std::size_t texels_with_rings(const TexelBuffer& buffer, std::uint32_t rings);

// One ring of new texels around all that have a value, in the order of pixels; whose light they take: finish_page().
// Error: cancelled.
Status dilate_once(Lightmap& map, std::span<const std::uint32_t> readers, Context& context);

// Fills invalid texels from the 3x3 neighbours of their own chart that have a value (repeated until nothing changes),
// then dilates `rings` rings around the charts. Both by coverage. A dilated texel takes the light of one chart alone:
// of the one whose bilinear lookups read it (`readers`: that chart per pixel, or kNone; empty where none is known),
// else, or where that one has no value beside it, of the one with most neighbours, the lowest id of equals. Later rings
// go on with it. Error: cancelled.
Result<Lightmap> finish_page(const TexelBuffer& buffer, RadianceSums sums, TexelSurface surface,
                             std::span<const std::uint32_t> readers, std::uint32_t rings, Context& context);

}  // namespace lumel
