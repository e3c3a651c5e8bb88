// Faces that go on in each other although their edges are not the same: the corner of one lies within the edge of the
// other, as builders of levels leave it. To the topology such edges are borders.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/crease.h"
#include "chart/topology.h"

namespace lumel {

// Pieces of border edges that run along each other in opposite directions, of triangles in one plane (2 degrees), as
// near as rounding or a ten-thousandth of the shorter edge. By ascending `a`, then `b`, each once.
std::vector<SmoothContact> t_junctions(const Mesh& mesh, const MeshTopology& topology);

// Unites clusters that lie in one plane (2 degrees over all that is united) and touch at T-junctions. Clusters as
// `segment` makes them, and so ordered.
std::vector<std::vector<std::uint32_t>> unite_across_t_junctions(const Mesh& mesh, const MeshTopology& topology,
                                                                 std::vector<std::vector<std::uint32_t>> clusters);

}  // namespace lumel
