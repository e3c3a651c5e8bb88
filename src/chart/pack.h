// Packs the charts of instances into pages: which instances share a page. How one page is filled is in pack/.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_mask.h"
#include "lumel/context.h"

namespace lumel {

struct PackItem {
    std::uint32_t mask = 0;   // index into the masks
    std::uint32_t group = 0;  // items of one group share a page if an empty page can hold them
};

struct PackSpot {
    std::uint32_t page = 0, x = 0, y = 0;
};

struct PackPage {
    std::uint32_t width = 0, height = 0;
    std::uint64_t used = 0;
};

struct Packing {
    std::vector<PackSpot> spots;  // beside the items
    std::vector<PackPage> pages;
    bool complete = false;  // false: cancelled, or what was asked does not fit
};

// As many pages as it takes, none wider or higher than `max_page`; sizes are multiples of 4 where that allows it. No
// chart is turned. The same for any number of threads.
// Precondition: items ordered by group; no mask larger than max_page.
Packing pack(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t max_page,
             Context& context);

// All on one page of this size, or not complete.
Packing pack_one_page(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t width,
                      std::uint32_t height, Context& context);

}  // namespace lumel
