// Who owns which texel of a page, for pictures of the layout and for checks.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"

namespace lumel {

// Per texel of the page: index into Atlas::placements of the chart that a bilinear lookup may take it for, or kNone. In
// a kept layout whose charts share texels the first in order of placements owns them.
std::vector<std::uint32_t> chart_ids(const Scene& scene, const ChartSet& charts, const Atlas& atlas,
                                     std::uint32_t page);

// A colour per texel, 3 bytes each: black where there is no chart, else a bright one by its id.
std::vector<std::uint8_t> color_ids(const std::vector<std::uint32_t>& ids);

}  // namespace lumel
