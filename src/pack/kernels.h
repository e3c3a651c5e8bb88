// The inner loops of packing, compiled for several instruction sets; the machine decides which run. Integers only: the
// answers are the same for all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pack/cover.h"
#include "pack/free_map.h"

namespace lumel {

// Where a search for positions stands, and the positions it found in that block: bit i of word w is
// x = block * 256 + w * 64 + i.
struct FitSearch {
    std::uint32_t y = 0, block = 0;
    std::array<std::uint64_t, FreeMap::kBlockWords> fits{};
};

// The surroundings of a chart: its box and two texels on each side, in columns of words, each column its rows in order,
// with an empty column before and after them.
struct FrameView {
    std::uint32_t columns = 0, rows = 0;
    const std::uint64_t* mask = nullptr;  // the chart
    const std::uint64_t* rim = nullptr;   // texels around it, also diagonally
    const std::uint64_t* side = nullptr;  // texels beside, above and below it
};

struct FrameRating {
    std::int32_t stranded = 0;  // texels of the rim that no free square of 2 x 2 holds any more
    std::int32_t open = 0;      // texels beside the chart that stay free
};

// 16 rows of 32 texels around a place for a tiny chart; bit = free, or taken by the chart.
inline constexpr std::uint32_t kTinyRows = 16;
using TinyWindow = std::array<std::uint32_t, kTinyRows>;

struct Kernels {
    // The next block at or after search.y, search.block where the squares fit at some x <= last_x, in rows up to last_y
    // (which exist). Precondition: squares are not empty.
    bool (*next_fit)(const FreeMap& map, const CoverSquare* squares, std::size_t count, std::uint32_t last_x,
                     std::uint32_t last_y, FitSearch& search);
    // What placing a chart costs its surroundings. `texels`: the row two above the chart's box, the word that holds the
    // texel two to its left, which is bit `shift`; `scratch`: 3 (columns + 2) rows words, of any content.
    FrameRating (*rate)(const FrameView& frame, const std::uint64_t* texels, std::size_t stride, std::uint32_t shift,
                        std::uint64_t* scratch);
    // The first i in [begin, end) with no bit of a[i], b[i] among the given ones; `end` if there is none. The arrays
    // may be read up to the next multiple of 16.
    std::size_t (*first_disjoint)(const std::uint64_t* a, const std::uint64_t* b, std::size_t begin, std::size_t end,
                                  std::uint64_t not_in_a, std::uint64_t not_in_b);
    // Free texels, away from the window's edge, in no free square of 2 x 2, counted twice, and those in none of 3 x 3.
    std::int32_t (*stranded)(const TinyWindow& free);
};

// The fastest that this machine runs.
const Kernels& kernels();
// All that it runs, the plainest first: for tests.
const Kernels* const* all_kernels(std::size_t& count);

}  // namespace lumel
