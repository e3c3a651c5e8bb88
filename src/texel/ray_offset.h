// Ray origins that provably lie off the surface they start on, and the smooth position against the shadow terminator.
#pragma once

#include "lumel/vec.h"
#include "scene/world_geometry.h"

namespace lumel {

// How far the computed point P = sum b_i p_i may lie from the triangle's plane, along unit normal n:
// d = gamma(7) sum_c |n_c| sum_i |b_i| |p_i,c| (algorithms: vertex error bound), in metres.
float plane_error(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, Vec3 normal);

// P + d * side_normal, rounded away from the plane per axis. `side_normal` is the geometric normal of the side that the
// ray leaves. A ray from here into that side does not meet the triangle again.
Vec3 offset_origin(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, Vec3 side_normal);

// The smooth position that only moves outward (Hanika 2021): P - sum_i b_i min(0, (P - V_i).n_i) n_i, for the front side;
// equal to P on flat triangles. Zero facets on convex low-poly meshes, no move on concave ones.
Vec3 smooth_position(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, bool back_side);

}  // namespace lumel
