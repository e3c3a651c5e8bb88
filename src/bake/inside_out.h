// Nodes that bake black because faces look the wrong way: their own, or those of what surrounds them.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "path/path_integrator.h"
#include "post/lightmap.h"

namespace lumel {

// Of smaller nodes nothing is said: a few texels may lie inside their neighbours for a reason.
inline constexpr std::uint64_t kFewestTexelsToWarn = 16;
// Of a node's texels, from which on the node is said to be dark, or to see backs.
inline constexpr double kShareToWarn = 0.9;

class InsideOutCheck {
public:
    explicit InsideOutCheck(const Atlas& atlas) : atlas_(atlas), nodes_(atlas.first_placement.size() - 1) {}

    // Counts the texels of a finished page.
    void add(const Lightmap& map);

    // Warnings: `backs-seen` for nodes whose texels mostly meet the backs of single-sided surfaces, and are invalid for
    // that; `inside-out` for others whose texels are dark while light of any layer reaches the other side of their
    // faces (a path in eight from there finds some). Any number of threads says the same.
    void warn(const Transport& transport, Diagnostics& diagnostics) const;

private:
    struct Node {
        std::uint64_t texels = 0, invalid = 0, dark = 0;
    };
    const Atlas& atlas_;
    std::vector<Node> nodes_;  // per Scene::instances
};

}  // namespace lumel
