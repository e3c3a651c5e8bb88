// Stage: the light of the texels of a page.
#pragma once

#include <cstddef>

#include "path/path_integrator.h"
#include "path/radiance_sums.h"
#include "path/texel_blocks.h"
#include "texel/texel_buffer.h"

namespace lumel {

// `first`, `count`: the range of texels to do (the rest of the sums stay zero); any split gives the same bits.
// `room`: texels that the sums can grow to without being moved. Error: cancelled.
Result<RadianceSums> gather_page(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                                 const Transport& transport, const PathOptions& options, std::size_t first,
                                 std::size_t count, Context& context, std::size_t room = 0);

// Some blocks of the page alone: sums of blocks.texels, in that order.
Result<RadianceSums> gather_blocks(const TexelBlocks& blocks, const TexelBuffer& texels, const ChartSet& charts,
                                   const Atlas& atlas, const Transport& transport, const PathOptions& options,
                                   Context& context);

}  // namespace lumel
