// Turns a chart so that its box is small and its edges run along the texel rows.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lumel {

// Rotates (no mirror, no scale) so that an edge of the convex hull is horizontal: the one of the smallest box; among
// boxes within 1 % of that, the longest edge. Then the box is at least as wide as high, and its corner is at (0, 0).
void align_to_box(std::vector<Eigen::Vector2d>& points);

}  // namespace lumel
