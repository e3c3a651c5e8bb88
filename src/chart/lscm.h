// Least-squares conformal map of a disc-like patch.
//
// Based on: Levy, Petitjean, Ray, Maillot, "Least squares conformal maps" (2002), in the form of Mullen, Tong, Alliez,
// Desbrun, "Spectral conformal parameterization" (2008): Dirichlet energy minus area, a symmetric system in u and v.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "chart/patch.h"

namespace lumel {

// UVs of the patch's vertices, with vertices `pin_a` and `pin_b` at the UVs given. Nothing where the system cannot be
// solved. Does not check flips or overlaps.
std::optional<std::vector<Eigen::Vector2d>> lscm(const Patch& patch, std::uint32_t pin_a, const Eigen::Vector2d& uv_a,
                                                 std::uint32_t pin_b, const Eigen::Vector2d& uv_b);

// A triangle laid into its own plane, first corner at 0, second on the x axis. Slivers are made a little less thin, so
// that their cotangents stay within what doubles can take.
std::array<Eigen::Vector2d, 3> lay_flat(const Patch& patch, std::size_t triangle);

}  // namespace lumel
