// How a texel lies in the world: what a step of one texel along each axis of the page is on the surface.
#pragma once

#include <array>

#include "lumel/vec.h"

namespace lumel {

// The inverse of the Jacobian of a triangle's map from world to texels: its columns, metres per texel. Both are zero
// where the triangle has no width in texels to measure by.
struct TexelAxes {
    Vec3 x{}, y{};
    [[nodiscard]] bool known() const { return x != Vec3{} || y != Vec3{}; }
};

// Of a triangle with these corners in the world and in texels.
TexelAxes texel_axes(const std::array<Vec3, 3>& world, const std::array<Vec2, 3>& texels);

// Metres across a texel of the triangle: the longer edge of the parallelogram that its square is on the surface, and
// the longest edge of the triangle where the axes are not known.
float metres_per_texel(const std::array<Vec3, 3>& world, const std::array<Vec2, 3>& texels);

}  // namespace lumel
