// Who owns which texel of a page, for pictures of the layout and for checks.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"

namespace lumel {

// Per texel of a mip of the page: index into Atlas::placements of the chart that a lookup under Atlas::masks may take
// it for, or kNone. In a kept layout whose charts share texels the first in order of placements owns them.
std::vector<std::uint32_t> chart_ids(const Scene& scene, const ChartSet& charts, const Atlas& atlas, std::uint32_t page,
                                     std::uint32_t mip = 0);

// Which triangle of the world shows at a texel, be it where the texel's own square meets it or where only a lookup
// takes the texel for it.
struct TexelOwners {
    std::vector<std::uint32_t> triangle;  // per texel of the page; kNone: free
    std::vector<std::uint8_t> covered;  // 1: its own square meets the triangle, so that it becomes a texel of the bake
};
TexelOwners texel_owners(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas,
                         std::uint32_t page);

// A colour per texel, 3 bytes each: black where there is no chart, else a bright one by its id.
std::vector<std::uint8_t> color_ids(const std::vector<std::uint32_t>& ids);

}  // namespace lumel
