// What the two phases of filling a page (large_charts.h, tiny_charts.h) share.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pack/free_map.h"
#include "pack/kinds.h"

namespace lumel {

struct PageSpot {
    bool placed = false;
    std::uint8_t orientation = 0;
    std::uint32_t x = 0, y = 0;  // of the top left corner of the oriented mask's box
};

struct PageFill {
    std::vector<PageSpot> spots;  // beside the charts
    std::uint32_t height = 0;     // last row taken + 1
    std::uint64_t used = 0;       // texels of the charts placed
    std::size_t placed = 0;       // charts
};

// One way to fill a page. They differ in what they are good at: see fill_page.cpp.
struct Strategy {
    bool irregular_first = true;       // large charts, but for huge ones, that are no rectangles go first
    bool turn_large = false;           // all eight orientations of large charts
    bool turn_tiny = true;             // and of tiny ones
    std::uint32_t candidates = 32;     // positions that are compared for a large chart; 0: the first one is taken
    std::int32_t stranded_weight = 2;  // of a stranded texel against one beside the chart that stays open
    std::uint32_t tiny_trials = 48;    // charts that are compared for a hole
};

// The page as it fills.
struct PageWork {
    PageWork(const Kinds& all, const Strategy& how, std::uint32_t width, std::uint32_t height, std::uint32_t max_level,
             std::size_t charts)
        : kinds(all), strategy(how), map(width, height, max_level) {
        fill.spots.resize(charts);
    }

    const Kinds& kinds;
    const Strategy& strategy;
    FreeMap map;
    PageFill fill;
    std::function<bool()> cancelled;
    std::function<void(std::size_t placed)> on_placed;  // may be none
    bool all_or_nothing = false;

    void placed(std::uint32_t chart, const ChartMask& mask, std::uint8_t orientation, std::uint32_t x, std::uint32_t y,
                std::uint32_t bottom) {
        fill.spots[chart] = {true, orientation, x, y};
        fill.height = bottom > fill.height ? bottom : fill.height;
        fill.used += mask.used;
        ++fill.placed;
        if (fill.placed % 16 == 0 && on_placed) on_placed(fill.placed);
    }
};

// Larger charts are not turned: there are few in a page, and all that is kept for a pose grows with their texels.
inline bool worth_turning(const ChartMask& mask) {
    constexpr std::uint64_t kMost = 512 * 512;
    return std::uint64_t{mask.width} * mask.height <= kMost;
}

// The orientations in which a mask looks different, in order; just 0 where it is not to be turned.
std::vector<std::uint8_t> distinct_orientations(const ChartMask& mask, bool turn);

}  // namespace lumel
