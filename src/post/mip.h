// Mips of a baked page, made chart by chart, so that light of one never runs into another.
#pragma once

#include <cstdint>
#include <span>

#include "post/lightmap.h"

namespace lumel {

// Mip `mip` (1 or more) of a finished page: each texel the mean over those of the 2^mip x 2^mip texels below it that
// have light of their chart (baked or filled; dilated ones repeat the light of others), whatever share of the texel
// they cover. Lightmap::leaks take no part; a texel that has nothing else is filled from those around it, ring by ring
// inwards, and is the mean of its leaks where there are none of its chart. Moments, light, normals and surface are
// means; the variance is that of a mean of independent texels. `readers`: the chart whose lookups in this mip read a
// pixel, or kNone (chart_ids()); where several charts have light in a texel, which layouts for this mip do not have, it
// is the reader's. `rings` rings are dilated around it for lookups beyond. Coverage: baked where some texel was, else
// filled. Error: cancelled.
Result<Lightmap> make_mip(const Lightmap& page, std::uint32_t mip, std::span<const std::uint32_t> readers,
                          std::uint32_t rings, Context& context);

}  // namespace lumel
