// Brings a map of a patch as near to an isometry as it can be.
//
// Based on: Liu, Zhang, Xu, Gotsman, Gortler, "A local/global approach to mesh parameterization" (2008), the
// as-rigid-as-possible energy: rotations of the triangles by their map, then positions by the rotations, whose matrix
// is the same in every step and factored once.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "chart/lscm.h"

namespace lumel {

// `steps` at most; fewer where the energy falls by less than a hundredth. Starts from `uv`, of the patch's size in
// metres, and leaves it alone where the system cannot be solved. Does not check flips or overlaps. The patch is
// connected.
void relax_as_rigid(const Patch& patch, int steps, std::vector<Eigen::Vector2d>& uv);

}  // namespace lumel
