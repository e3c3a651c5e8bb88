// Connectivity of one mesh with its positions welded: which triangles are neighbours across which edges. Vertices that
// a file split for normals or textures are one point here.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lumel/scene.h"

namespace lumel {

// Edge `3 * t + k` of a mesh runs from corner k to corner (k + 1) % 3 of triangle t.
struct MeshTopology {
    std::vector<std::uint32_t> point;  // per vertex: the first vertex of the file at the same position
    std::vector<std::uint32_t> twin;   // per edge: the same edge seen from the neighbour, or kNone at a border
    std::vector<Vec3> normal;          // per triangle, unit; zero where it has no area
    std::vector<double> area;          // per triangle; exactly 0 for zero-area triangles

    [[nodiscard]] std::size_t triangle_count() const { return area.size(); }
};

// Non-manifold edges are resolved in pairs: of the triangles around one, those that continue each other most smoothly
// are neighbours (so that the two layers of a sheet with its own back faces stay apart). Zero-area triangles have no
// neighbours.
MeshTopology build_topology(const Mesh& mesh);

// Corner `k` of triangle `t` in the mesh's vertices.
inline std::uint32_t corner_vertex(const Mesh& mesh, std::uint32_t edge) { return mesh.triangles[edge / 3][edge % 3]; }
inline std::uint32_t next_edge(std::uint32_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }

// Twice the area of a triangle relative to its longest edge squared below which it counts as having none: thinner than
// the rounding of its own corners.
inline constexpr double kZeroAreaRatio = 1e-8;

}  // namespace lumel
