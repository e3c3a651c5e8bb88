// Where two borders of charts are the same line in the world, but not of the layout: UV seams inside a mesh,
// T-junctions, and edges that different instances share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"
#include "seam/border_edges.h"

namespace lumel {

struct SeamRule {
    float distance = 1e-3f;            // metres: of two lines that are taken for one
    float distance_in_texels = 0.1f;   // and of the texels of either: in scenes of millimetres all is within one
    float normal_cosine = 0.9396926f;  // 20 degrees: of normals of one surface
    float same_texels = 0.02f;         // texels: lookups so near each other are one
};

// The piece of edge `a` between two of its parameters (0 at `from`, 1 at `to`), and what of edge `b` it runs along.
struct Seam {
    std::uint32_t a = 0, b = 0;
    float a_from = 0.0f, a_to = 0.0f, b_from = 0.0f, b_to = 0.0f;
};

// Every pair once, by ascending a < b. Pairs whose normals differ by more than the gate all along, those that look up
// the same texels, and those whose triangles lie on one side of the line, one on the other, are left out. n log n in
// the number of edges, plus the pairs that are near each other. Stage "seams". Error: cancelled.
Result<std::vector<Seam>> find_seams(std::span<const BorderEdge> edges, const SeamRule& rule, Context& context);

inline Vec3 position_at(const BorderEdge& edge, float t) { return edge.from + (edge.to - edge.from) * t; }
inline Vec2 texels_at(const BorderEdge& edge, float t) {
    return edge.texels_from + (edge.texels_to - edge.texels_from) * t;
}
inline Vec3 normal_at(const BorderEdge& edge, float t) {
    return normalize_or(edge.normal_from + (edge.normal_to - edge.normal_from) * t, edge.normal_from);
}

}  // namespace lumel
