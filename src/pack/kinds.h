// Charts grouped by equal masks: what is found out for one holds for all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pack/mask.h"

namespace lumel {

struct Kind {
    const ChartMask* mask = nullptr;
    std::uint32_t first = 0, count = 0;  // into Kinds::charts
};

struct Kinds {
    std::vector<Kind> kinds;            // by their first chart
    std::vector<std::uint32_t> charts;  // grouped by kind, in order
};

// `mask_of`: the mask of each chart.
Kinds group_equal(std::span<const ChartMask> masks, std::span<const std::uint32_t> mask_of);

}  // namespace lumel
