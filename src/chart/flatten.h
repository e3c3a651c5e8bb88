// Lays one cluster of triangles flat as one chart, and judges what came of it.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/overlap.h"
#include "chart/patch.h"
#include "chart/topology.h"

namespace lumel {

// A chart in its plane: metres of mesh space, area-preserving as a whole, bounds from (0, 0).
struct FlatChart {
    std::vector<std::uint32_t> triangles;  // of the mesh, ascending
    std::vector<UvTriangle> uv;            // beside them
    std::vector<std::uint32_t> cuts = {};  // edges, ascending, with both triangles in the chart that are borders of it
    bool islands = false;                  // parts that only touch at T-junctions: they keep their places to each other
};

struct FlattenOptions {
    double planar_cos = 0.9994;  // all normals this near to the mean one: projected (2 degrees, area error below 0.1 %)
    double max_stretch = 1.1;    // Sander's L2 of a chart above which it is no chart
    int relax_steps = 12;        // of as-rigid-as-possible relaxation after the conformal map
};

// One way to lay out a cluster, and what is wrong with it.
struct Attempt {
    std::vector<UvTriangle> uv;          // beside the triangles; metres of mesh space, bounds from (0, 0)
    std::vector<std::uint32_t> defects;  // positions in the cluster of triangles without which it may be injective
    double stretch = 0.0;                // Sander's L2
    bool stretched = true;               // beyond what was allowed, or no map at all

    [[nodiscard]] bool good() const { return !stretched && defects.empty(); }
};

// The projection of what lies in one plane and need not hang together; stretched where it does not lie in one.
Attempt flatten_planar(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                       const FlattenOptions& options);

// An edge-connected cluster as one chart if it can be; else the more hopeful of the ways that were tried. One triangle
// is always good.
Attempt flatten_whole(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                      const FlattenOptions& options);

// Judges a map of the patch of these triangles: scaled to the area of the surface and turned into its smallest box.
Attempt attempt(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                const Patch& patch, Uvs uv, double max_stretch);

// Is every triangle counter-clockwise, and are no two on top of each other by more than the rounding of UVs?
bool is_injective(const std::vector<UvTriangle>& uv);

// Sander, Snyder, Gortler, Hoppe, "Texture mapping progressive meshes" (2001): the area-weighted L2 stretch, with the
// whole scaled to equal areas; 1 for an isometry. Infinite where a triangle has lost its area.
double l2_stretch(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const std::vector<UvTriangle>& uv);

}  // namespace lumel
