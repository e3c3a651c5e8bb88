// Ray origins that provably lie off the surface they start on, and the smooth position against the shadow terminator.
// The error bounds are derived in docs/ray-offset.md.
#pragma once

#include "lumel/vec.h"
#include "scene/world_geometry.h"

namespace lumel {

// How far the computed point P = sum b_i p_i may lie from the triangle's plane, along unit normal n, in metres:
// gamma(7) sum_c |n_c| sum_i |b_i| |p_i,c|. Barycentrics in [0, 1].
float plane_error(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, Vec3 normal);

// P + (plane_error + tracer_error) * side_normal, rounded away from the plane per axis. `side_normal` is the geometric
// normal of the side that the ray leaves. A ray from here into that side does not meet the triangle again; occluders
// nearer than twice the offset may be missed.
Vec3 offset_origin(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, Vec3 side_normal);

// The smooth position that only moves outward: P - 1/2 sum_i b_i min(0, (P - V_i).n_i) n_i, for the front side; equal
// to P on flat triangles. On a convex mesh it is the point of the curved surface that the vertex normals describe, from
// where no facet of the mesh reaches into the hemisphere of the vertex normal; concave ones stay where they are.
Vec3 smooth_position(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, bool back_side);

}  // namespace lumel
