// Packs charts into one page, or as many as it takes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/context.h"
#include "pack/fill_page.h"
#include "pack/mask.h"

namespace lumel {

struct PackOptions {
    std::uint32_t width = 0;     // of a page, texels; 0: see default_width(). At most max_page and FreeMap::kMaxWidth
    std::uint32_t max_page = 0;  // longest edge of a page; 0: one page as high as it takes
    Orientations orientations = Orientations::automatic;
};

struct PackedChart {
    std::uint32_t page = 0, x = 0, y = 0;  // of the top left corner of the oriented mask's box
    std::uint8_t orientation = 0;          // mask.h
};

struct PackedPage {
    std::uint32_t height = 0;  // last row taken + 1
    std::uint64_t used = 0;
};

struct PagePacking {
    std::uint32_t width = 0;
    std::vector<PackedChart> charts;  // beside the masks
    std::vector<PackedPage> pages;
    bool complete = false;  // false: cancelled
};

// A page that is about square where 98 % of it is used, but no narrower than the widest chart.
std::uint32_t default_width(std::span<const ChartMask> masks);

// About the most memory that the free map of a page (free_map.h) takes: for rows as if half of the page were boxes of
// charts. Much more than the masks' own where a page is narrow or rows of it hold few texels.
std::uint64_t page_bytes(std::span<const ChartMask> masks, const PackOptions& options);

// Where one page does not hold all, the charts that are hardest to place go to the first ones; a page is filled before
// the next one is begun. The same for any number of threads.
// Precondition: no mask is wider than the width, or higher than max_page.
PagePacking pack_pages(std::span<const ChartMask> masks, const PackOptions& options, Context& context);

}  // namespace lumel
