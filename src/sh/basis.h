// Basis S: real orthonormal spherical harmonics to band 2 with Condon-Shortley signs (docs/conventions.md).
// Based on: Sloan 2008, "Stupid Spherical Harmonics Tricks"; signs as in Roughton et al. 2024.
#pragma once

#include <array>

#include "lumel/vec.h"

namespace lumel {

inline constexpr float kSh0 = 0.28209479177387814f;   // 1/(2 sqrt(pi))
inline constexpr float kSh1 = 0.48860251190291992f;   // sqrt(3/(4 pi))
inline constexpr float kSh2 = 1.0925484305920792f;    // sqrt(15/(4 pi))
inline constexpr float kSh20 = 0.31539156525252005f;  // sqrt(5/(16 pi))
inline constexpr float kSh22 = 0.54627421529603959f;  // sqrt(15/(16 pi))

// Values of the nine functions in a unit direction; index l(l+1)+m.
using ShBasis = std::array<float, 9>;

constexpr ShBasis sh_basis(Vec3 d) {
    return {kSh0,
            -kSh1 * d.y,
            kSh1 * d.z,
            -kSh1 * d.x,
            kSh2 * d.x * d.y,
            -kSh2 * d.y * d.z,
            kSh20 * (3.0f * d.z * d.z - 1.0f),
            -kSh2 * d.x * d.z,
            kSh22 * (d.x * d.x - d.y * d.y)};
}

}  // namespace lumel
