// Places charts larger than 8 x 8 texels, from large to small.
//
// Based on: first fit by decreasing width + height (O'Donnell, "Precomputed Global Illumination in Frostbite", 2018).
// Different here: exact first fit, as the free map (free_map.h) tests all positions of a row at once; equal masks go on
// where the last one was found, which is exact, too, since room only shrinks; and of the first positions at the
// ends of runs of them (where a chart mostly touches something to its left or right) that one is taken that strands the
// fewest texels and leaves the fewest beside it free.
#pragma once

#include <span>

#include "pack/page_work.h"

namespace lumel {

// The level that the free map needs for charts of these kinds.
std::uint32_t level_of(const ChartMask& mask);

// What does not fit stays unplaced. Returns early where the work is cancelled; false where it is all or nothing and a
// chart did not fit.
bool place_large_charts(PageWork& work, std::span<const std::uint32_t> kinds);

}  // namespace lumel
