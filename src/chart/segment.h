// Cuts a mesh into clusters that can be flattened with little stretch: flat regions first, then clusters merged
// bottom-up while their normals stay within a cone.
//
// Based on: Garland, Willmott, Heckbert, "Hierarchical face clustering on polygonal surfaces" (2001): greedy merging of
// neighbours by a priority queue; Cohen-Steiner, Alliez, Desbrun, "Variational shape approximation" (2004): the L2,1
// normal error. Here the cost is the growth of that error over the square of the length of seam that the merge removes,
// which is free of units and prefers long seams.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "chart/topology.h"

namespace lumel {

struct SegmentOptions {
    double cone_cos = 0.34202;  // cosine of the largest half angle of a cluster's normals: 70 degrees
    double hard_crease_cos =
        0.8660254037844387;  // an edge whose vertex normals differ cuts above this angle: 30 degrees
    double soft_crease_cos = 0.2588190451025207;  // an edge with common vertex normals cuts above this one: 75 degrees
    double planar_cos = 0.99998;  // normals this near to the first triangle's are one plane: 0.36 degrees
};

// Edge-connected triangle lists, ascending, ordered by their first triangle. Zero-area triangles are in none of them.
// `cancelled` is polled; once it says true the result is incomplete and must not be used.
std::vector<std::vector<std::uint32_t>> segment(const Mesh& mesh, const MeshTopology& topology,
                                                const SegmentOptions& options, const std::function<bool()>& cancelled);

}  // namespace lumel
