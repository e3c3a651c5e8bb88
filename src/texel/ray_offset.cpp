// Based on: Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., section 6.8 (bounds of rounding errors,
// points rounded away from the surface); Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection" (edges
// relative to the ray's origin); Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4.
// Different here: the tracer's own error is part of the bound; without it, large triangles near the origin of the
// coordinates shade themselves. And the smooth position takes half of Hanika's step, see there.
#include "texel/ray_offset.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "math/constants.h"

namespace lumel {
namespace {

Vec3 abs(Vec3 v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

// fl(x + step), then one float further: not nearer than the exact sum. Without branches: the signs of a point and of a
// normal cannot be foretold.
float add_away(float x, float step) {
    const float sum = x + step;
    const std::int32_t towards = (step > 0.0f) - (step < 0.0f);
    constexpr std::uint32_t kLeastBelowZero = 0x80000001u, kLeastAboveZero = 1u;  // bits: denormals may be flushed
    if (sum == 0.0f) return towards == 0 ? sum : std::bit_cast<float>(towards < 0 ? kLeastBelowZero : kLeastAboveZero);
    const auto bits = std::bit_cast<std::int32_t>(sum);
    return std::bit_cast<float>(bits + towards * (1 | (bits >> 31)));  // floats count away from zero on both sides
}

using Corners = std::array<Vec3, 3>;

float plane_error(const Corners& p, float b1, float b2, Vec3 normal) {
    const Vec3 magnitude =
        abs(p[0]) * std::fabs(1.0f - b1 - b2) + abs(p[1]) * std::fabs(b1) + abs(p[2]) * std::fabs(b2);
    return gamma_bound(7) * dot(abs(normal), magnitude);
}

}  // namespace

float plane_error(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, Vec3 normal) {
    return plane_error(geometry.corners(triangle), b1, b2, normal);
}

Vec3 offset_origin(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, Vec3 side_normal) {
    const Corners corners = geometry.corners(triangle);
    const Vec3 p = corners[0] * (1.0f - b1 - b2) + corners[1] * b1 + corners[2] * b2;
    const float d = plane_error(corners, b1, b2, side_normal) + geometry.triangles[triangle].tracer_error;
    return {add_away(p.x, d * side_normal.x), add_away(p.y, d * side_normal.y), add_away(p.z, d * side_normal.z)};
}

Vec3 smooth_position(const WorldGeometry& geometry, std::uint32_t triangle, float b1, float b2, bool back_side) {
    const Vec3 p = geometry.position(triangle, b1, b2);
    const WorldTriangle& t = geometry.triangles[triangle];
    if ((t.flags & kCurved) == 0) return p;
    // A chord's point is as far below the arc as the arc is below the tangent plane: the height below the plane counts
    // twice. The full step would leave a sphere by as much as the facets are inside it.
    constexpr float kStep = 0.5f;
    const float side = back_side ? -1.0f : 1.0f;
    const Vec3 face_normal = geometry.geometric_normal(triangle) * side;
    const std::array<float, 3> weights{1.0f - b1 - b2, b1, b2};
    Vec3 move{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 n = geometry.normals[t.vertices[i]] * side;
        const float height = dot(p - geometry.positions[t.vertices[i]], n);  // below the tangent plane: negative
        // A normal that points behind the face would move the point through it.
        if (height < 0.0f && dot(n, face_normal) > 0.0f) move -= n * (kStep * weights[i] * height);
    }
    return p + move;
}

}  // namespace lumel
