// Places charts of at most 8 x 8 texels, hole by hole.
//
// The page is read in rows. At each free texel all tiny charts that are left are looked at in the order of how hard
// they are to place; the first that fits with its first texel there and strands nothing is taken, else the one that
// strands least. So large numbers of tiny charts fill what the large ones left, down to holes of 2 x 2, and end in a
// dense band.
#pragma once

#include <span>

#include "pack/page_work.h"

namespace lumel {

inline constexpr std::uint32_t kTinySize = 8;

// Masks whose box is tight and no larger than that.
bool is_tiny(const ChartMask& mask);

// What does not fit stays unplaced. Afterwards the map is used up. Returns early where the work is cancelled.
void place_tiny_charts(PageWork& work, std::span<const std::uint32_t> kinds);

}  // namespace lumel
