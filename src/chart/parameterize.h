// Flattens clusters of triangles into charts that are injective: no flipped triangle, no overlap.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "chart/overlap.h"
#include "chart/topology.h"

namespace lumel {

// A chart in its plane: metres of mesh space, area-preserving as a whole, bounds from (0, 0).
struct FlatChart {
    std::vector<std::uint32_t> triangles;  // of the mesh, ascending
    std::vector<UvTriangle> uv;            // beside them
};

struct ParameterizeOptions {
    double planar_cos = 0.9994;  // all normals this near to the mean one: projected (2 degrees, area error below 0.1 %)
    double max_stretch = 1.25;   // Sander's L2 of a chart above which it is split
    int max_splits = 12;         // halvings in a row, after which what is left is cut by box sides
};

struct Parameterized {
    std::vector<FlatChart> charts;
    std::uint32_t fallbacks = 0;  // clusters that ended in the box projection
};

// One edge-connected cluster becomes one chart; or, where that overlaps, flips or stretches, several.
Parameterized parameterize(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& cluster,
                           const ParameterizeOptions& options, const std::function<bool()>& cancelled);

// Is every triangle counter-clockwise, and are no two on top of each other by more than the rounding of UVs?
bool is_injective(const std::vector<UvTriangle>& uv);

// Sander, Snyder, Gortler, Hoppe, "Texture mapping progressive meshes" (2001): the area-weighted L2 stretch, with the
// whole scaled to equal areas; 1 for an isometry. Infinite where a triangle has lost its area.
double l2_stretch(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const std::vector<UvTriangle>& uv);

}  // namespace lumel
