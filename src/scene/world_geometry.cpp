// Queries on the flattened geometry. They lie on the path of every ray: no allocation, no branches but the sign test.
//
// Cross products are taken in double: the products of float differences are exact there, so the side of a face and
// whether it is flat to zero never hang on rounding, at any scale.
#include "scene/world_geometry.h"

#include <algorithm>
#include <cmath>

#include "math/constants.h"

namespace lumel {
namespace {

struct Cross {
    double x, y, z;
    [[nodiscard]] double squared() const { return x * x + y * y + z * z; }
    [[nodiscard]] Vec3 unit(double length) const {
        return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
    }
};

// Twice the area vector of the front face.
Cross front_cross(const WorldGeometry& geometry, const WorldTriangle& triangle) {
    const Vec3 a = geometry.positions[triangle.vertices[0]];
    const Vec3 b = geometry.positions[triangle.vertices[1]];
    const Vec3 c = geometry.positions[triangle.vertices[2]];
    const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
    const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
    const double side = (triangle.flags & kMirrored) != 0 ? -1.0 : 1.0;
    return {side * (uy * vz - uz * vy), side * (uz * vx - ux * vz), side * (ux * vy - uy * vx)};
}

Vec3 face_normal(const Cross& front) {
    const double squared = front.squared();
    return squared > 0.0 ? front.unit(std::sqrt(squared)) : Vec3{};
}

}  // namespace

Vec3 WorldGeometry::compute_normal(std::uint32_t triangle) const {
    return face_normal(front_cross(*this, triangles[triangle]));
}

float WorldGeometry::compute_tracer_error(std::uint32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    const Vec3 extent = max(max(a, b), c) - min(min(a, b), c);
    const float longest = max_component(extent);
    constexpr float kThinnest = 0x1p-11f;  // area per squared length
    const float area = std::max(0.5f * length(cross(b - a, c - a)), kThinnest * longest * longest);
    if (!(area > 0.0f)) return 0.0f;
    return kFloatEpsilon * longest + 3.0f * gamma_bound(8) * (extent.x * extent.y) * (extent.z / area);
}

float WorldGeometry::area(std::uint32_t triangle) const {
    return static_cast<float>(0.5 * std::sqrt(front_cross(*this, triangles[triangle]).squared()));
}

}  // namespace lumel
