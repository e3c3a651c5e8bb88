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

#include "chart/crease.h"
#include "chart/topology.h"

namespace lumel {

// Cosines of angles.
struct SegmentOptions {
    double cone_cos = 0.34202;    // 70 degrees: the largest half angle of a cluster's normals
    CreaseRule crease;            // where clusters are cut
    double planar_cos = 0.99998;  // 0.36 degrees: normals this near to the first triangle's are one plane
};

// Edge-connected triangle lists, ascending, ordered by their first triangle. Zero-area triangles are in none of them.
// `cancelled` is polled; once it says true the result is incomplete and must not be used.
std::vector<std::vector<std::uint32_t>> segment(const Mesh& mesh, const MeshTopology& topology,
                                                const SegmentOptions& options, const std::function<bool()>& cancelled);

}  // namespace lumel
