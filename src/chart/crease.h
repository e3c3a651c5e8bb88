// Where light on a surface changes abruptly anyway, so that a cut between two charts costs nothing there; and what is
// cut elsewhere, the smooth seams of a layout.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/topology.h"

namespace lumel {

// Cosines of the angle between the normals of two neighbours.
struct CreaseRule {
    double hard_cos = 0.8660254;  // 30 degrees: a sharper edge is one where the vertex normals of its sides differ
    double soft_cos = 0.2588190;  // 75 degrees: a sharper edge is one even where the vertex normals agree
};

// `edge` must have a twin. The same for both sides of an edge.
bool is_crease(const Mesh& mesh, const MeshTopology& topology, const CreaseRule& rule, std::uint32_t edge);

double edge_length(const Mesh& mesh, std::uint32_t edge);

// Where two triangles go on in each other without a crease, whether or not a layout cuts there: the piece of edge
// `a` between its parameters `a_from` and `a_to` (0 at its first corner, 1 at the second), which is that of edge `b`
// between `b_from` and `b_to`. Pieces that are not the whole of both edges are T-junctions.
struct SmoothContact {
    std::uint32_t a, b;
    double a_from = 0.0, a_to = 1.0, b_from = 1.0, b_to = 0.0;
    double length;  // metres of mesh space
};

// All of a mesh, by ascending `a`, each once.
std::vector<SmoothContact> smooth_contacts(const Mesh& mesh, const MeshTopology& topology, const CreaseRule& rule);

}  // namespace lumel
