// A piece of a mesh with vertices of its own, as maps are made of.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "chart/topology.h"

namespace lumel {

// Triangles are consistently oriented and, where one list of the mesh's became one patch, in its order.
struct Patch {
    std::vector<Eigen::Vector3d> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

using Uvs = std::vector<Eigen::Vector2d>;  // per vertex of a patch

// The triangles as a patch. Corners are one vertex where they meet across an inner edge, so a point where two fans
// touch stays two vertices. `triangles` ascend, and so do `cuts`, inner edges that are to be borders.
Patch make_patch(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                 const std::vector<std::uint32_t>& cuts = {});

// Position of a triangle in an ascending list, or kNone.
std::uint32_t index_in(const std::vector<std::uint32_t>& sorted, std::uint32_t triangle);

// Splits an ascending list of triangles into its edge-connected parts, in order of their first triangles.
std::vector<std::vector<std::uint32_t>> connected_parts(const MeshTopology& topology,
                                                        const std::vector<std::uint32_t>& triangles);

// Unit, weighted by area.
Eigen::Vector3d mean_normal(const MeshTopology& topology, const std::vector<std::uint32_t>& triangles);

// Are all normals within this angle of `normal`?
bool is_planar(const MeshTopology& topology, const std::vector<std::uint32_t>& triangles, const Eigen::Vector3d& normal,
               double planar_cos);

// Orthographic projection along `normal`: exact for planar patches.
Uvs project(const Patch& patch, const Eigen::Vector3d& normal);

double area_3d(const Patch& patch);
double area_2d(const Patch& patch, const Uvs& uv);  // signed

}  // namespace lumel
