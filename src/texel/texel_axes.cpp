#include "texel/texel_axes.h"

#include <algorithm>
#include <cmath>

namespace lumel {

TexelAxes texel_axes(const std::array<Vec3, 3>& world, const std::array<Vec2, 3>& texels) {
    const Vec3 p = world[1] - world[0], q = world[2] - world[0];
    const double ux = double{texels[1].x} - texels[0].x, uy = double{texels[1].y} - texels[0].y;
    const double vx = double{texels[2].x} - texels[0].x, vy = double{texels[2].y} - texels[0].y;
    const double twice_area = ux * vy - uy * vx;
    // Below one part in 10^5 a triangle has no width to measure by; all of it lies within a texel's breadth.
    const double squared_length = std::max({ux * ux + uy * uy, vx * vx + vy * vy});
    if (!(std::fabs(twice_area) > 1e-5 * squared_length)) return {};
    const auto s = [&](double x) { return static_cast<float>(x / twice_area); };
    return {p * s(vy) - q * s(uy), q * s(ux) - p * s(vx)};
}

float metres_per_texel(const std::array<Vec3, 3>& world, const std::array<Vec2, 3>& texels) {
    const TexelAxes axes = texel_axes(world, texels);
    if (axes.known()) return std::max(length(axes.x), length(axes.y));
    return std::max({length(world[1] - world[0]), length(world[2] - world[0]), length(world[2] - world[1])});
}

}  // namespace lumel
