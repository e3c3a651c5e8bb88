// Packs each group of charts into an atlas of its own: radiosity systems, light sets, cells that are streamed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/context.h"
#include "pack/pack_pages.h"

namespace lumel {

struct GroupOptions {
    std::uint32_t multiple = 1;  // widths and heights are multiples of this, texels: 4 for blocks
    std::uint32_t max_page = 0;  // longest edge; 0: any
    Orientations orientations = Orientations::automatic;
};

struct GroupPage {
    std::uint32_t width = 0, height = 0;
    std::uint64_t used = 0;  // texels of its charts

    [[nodiscard]] std::uint64_t area() const { return std::uint64_t{width} * height; }
};

struct GroupPacking {
    std::vector<PackedChart> charts;       // beside the masks; their page is their group
    std::vector<GroupPage> groups;         // without size where no chart is of a group
    std::vector<std::uint32_t> too_large;  // groups that max_page does not hold: their charts lie nowhere
    bool complete = false;                 // false: cancelled
};

// `group_of`: of each chart its group, 0 .. `groups` - 1. Pages are about square, of the least area that a few widths
// give. The same for any number of threads.
// Precondition: no mask is wider or higher than max_page.
GroupPacking pack_groups(std::span<const ChartMask> masks, std::span<const std::uint32_t> group_of,
                         std::uint32_t groups, const GroupOptions& options, Context& context);

}  // namespace lumel
