// Equirectangular maps: pixels and directions, lookup, integrals, and preparation. All in map space (rotation undone).
#pragma once

#include <array>
#include <vector>

#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// (u, v) -> direction and back, by the convention of SkyMap; u, v in [0, 1].
Vec3 sky_direction(float u, float v);
Vec2 sky_coordinates(Vec3 direction);

// Radiance, bilinear between pixel centres: wraps in u, clamps in v.
Vec3 lookup(const SkyMap& map, Vec2 uv);
Vec3 lookup(const SkyMap& map, Vec3 direction);

// direction.y at the upper edge of each row, and at the lower edge of the last: 1 to -1.
std::vector<double> row_edge_sines(std::uint32_t height);
// Integral over the sphere, pixels taken as constant.
std::array<double, 3> integrate(const SkyMap& map);

// Energy-preserving low-pass: every pixel becomes the mean radiance over a cone of the given half angle (radians, up to
// pi), then the map is rescaled so that its integral over the sphere is exactly kept per channel. Where the cone covers
// more than 32 rows to either side the result has half as many rows and columns, and so on.
SkyMap blur_sky(const SkyMap& map, float half_angle);

// Finds the sun's disc (the connected set of pixels around the brightest that stand out of the rest), replaces it by
// its surroundings and returns it as a directional light with the removed irradiance, colour and angular size. Error:
// unsupported where no pixel stands out as a sun.
struct ExtractedSun {
    SkyMap sky;
    Light sun;
};
Result<ExtractedSun> extract_sun(const SkyMap& map);

}  // namespace lumel
