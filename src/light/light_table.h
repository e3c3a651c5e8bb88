// How often each group of the local lights (LightSet::groups()) is chosen around one place, instead of asking the tree
// from its root at every point: what paths from there have learned goes into it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lumel {

// ends[g]: the first unit (math/discrete.h) beyond group g.
struct LightTable {
    std::vector<std::uint32_t> ends;

    [[nodiscard]] std::uint32_t begin(std::size_t group) const { return group == 0 ? 0 : ends[group - 1]; }
    [[nodiscard]] std::uint32_t units(std::size_t group) const { return ends[group] - begin(group); }
};

}  // namespace lumel
