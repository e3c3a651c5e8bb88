// Which objects share pages, by where they are: what a level streams in with a place is on few pages then.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/pack.h"
#include "lumel/vec.h"

namespace lumel {

// Items of one group (PackItem::group) and where they are in the world.
struct PackPlace {
    std::uint32_t group = 0;
    Vec3 centre{};           // metres
    std::uint64_t used = 0;  // texels of its masks, above 0
};

// At most so many parts of about equal texels: halved across the longest side of the box around its centres where that
// shares the texels out best, and so on (a k-d tree). Parts are lists of indices of places, ascending. No part is
// empty.
std::vector<std::vector<std::uint32_t>> cluster_places(std::span<const PackPlace> places, std::uint32_t parts);

// As pack() does, but pages hold groups that are near each other. `pages` 0: as many parts as texels fill pages of
// max_page, and those that are still more than a page are halved. Else so many parts, each on a page of its own, and
// not complete where one does not fit.
// Precondition: those of pack(); a place for each group, in the order of groups.
Packing pack_clusters(std::span<const ChartMask> masks, std::span<const PackItem> items,
                      std::span<const PackPlace> places, std::uint32_t max_page, std::uint32_t pages, Context& context);

}  // namespace lumel
