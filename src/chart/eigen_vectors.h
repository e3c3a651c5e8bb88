// Lumel's vectors as Eigen's in double precision, for the solvers of charts.
#pragma once

#include <Eigen/Core>

#include "lumel/vec.h"

namespace lumel {

inline Eigen::Vector3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
inline Eigen::Vector2d to_double(Vec2 v) { return {v.x, v.y}; }

inline double cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace lumel
