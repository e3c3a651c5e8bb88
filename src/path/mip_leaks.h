// Texels that would leak into the mips of a page: near enough behind a wall that a texel of a mip averages them with
// those before it.
// Based on: the article "Baking artifact-free lightmaps on the GPU" (2018): rays along the surface, as long as half a
// texel of the lowest mip is wide, that meet back faces.
#pragma once

#include <cstdint>
#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"
#include "path/path_integrator.h"
#include "texel/texel_buffer.h"

namespace lumel {

inline constexpr std::uint32_t kMipLeakRays = 8;  // of a texel, evenly around: four may miss what stands askew

// 1 for each texel where one of the rays, from half a texel of `mip` away, meets a back face. Both sides of
// double-sided surfaces are fronts. Error: cancelled.
Result<std::vector<std::uint8_t>> find_mip_leaks(const TexelBuffer& texels, const Transport& transport,
                                                 std::uint32_t mip, Context& context);

}  // namespace lumel
