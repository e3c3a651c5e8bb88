// Packs charts around others that stay where they are.
#pragma once

#include <span>
#include <vector>

#include "chart/pack.h"

namespace lumel {

// Beside the items: where an item lies and stays; page kNone: to be placed. Those that lie off their page or on a texel
// that an item before them has are set to kNone; returns how many that were.
std::size_t drop_conflicts(std::span<const ChartMask> masks, std::span<const PackItem> items,
                           std::span<const PackPage> pages, std::span<PackSpot> kept);

// The others go into free room of the pages, in their order. What finds none makes one of the pages higher or wider, or
// both, by multiples of 4: that which grows by the least. Where that is more than 2 % of all pages, and new pages for
// what waits are smaller, these come instead; and where no page may grow enough, all grow in turn before. No page
// shrinks; those at the end that nothing is left on go. With a `max_page` of 0 pages stay as they are, and the packing
// is incomplete if some found no room. Precondition: no conflicts; items ordered by group; no mask larger than
// max_page.
Packing pack_around(std::span<const ChartMask> masks, std::span<const PackItem> items, std::span<const PackSpot> kept,
                    std::span<const PackPage> pages, std::uint32_t max_page, Context& context);

}  // namespace lumel
