// Flattens clusters of triangles into charts that are injective: no flipped triangle, no overlap.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "chart/flatten.h"
#include "chart/overlap.h"
#include "chart/topology.h"

namespace lumel {

struct ParameterizeOptions {
    FlattenOptions flatten;
    int max_splits = 12;  // halvings in a row, after which what is left is cut by box sides
};

struct Parameterized {
    std::vector<FlatChart> charts;
    std::uint32_t fallbacks = 0;  // clusters that ended in the box projection
};

// A cluster becomes one chart; or, where that overlaps, flips or stretches, several. What is not edge-connected lies in
// one plane, or becomes several.
Parameterized parameterize(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& cluster,
                           const ParameterizeOptions& options, const std::function<bool()>& cancelled);

}  // namespace lumel
