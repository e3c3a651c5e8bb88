// What is symmetric about an axis: zonal coefficients, and the SH of the two lights that have closed forms.
#pragma once

#include <array>
#include <cmath>

#include "sh/rotate.h"

namespace lumel {

// Coefficients of bands 0..2 about unit axis n: those of Y_0, Y_2, Y_6 in a frame whose z axis is n.
template <class T>
constexpr std::array<T, 3> zonal_coefficients(const RadianceSh<T, 9>& sh, Vec3 n) {
    constexpr float kSqrt4PiOver5 = 1.5853309190424043f;
    const ShBasis y = sh_basis(n);
    T quadratic = sh.c[4] * y[4];
    for (std::size_t i = 5; i < 9; ++i) quadratic = quadratic + sh.c[i] * y[i];
    return {sh.c[0], detail::row_times(n, linear_vector(sh.c)), quadratic * kSqrt4PiOver5};
}

// The direction that the linear band points to; `fallback` where it is zero. For RGB give it the luminance.
template <std::size_t N>
Vec3 optimal_linear_direction(const RadianceSh<float, N>& sh, Vec3 fallback) {
    const ShVector<float> v = linear_vector(sh.c);
    return normalize_or({v.x, v.y, v.z}, fallback);
}

template <std::size_t N>
constexpr RadianceSh<float, N> luminance(const RadianceSh<Vec3, N>& sh) {
    RadianceSh<float, N> out;
    for (std::size_t i = 0; i < N; ++i) out.c[i] = luminance(sh.c[i]);
    return out;
}

// A light along unit direction d that gives I(n) = c max(n.d, 0) before truncation.
template <class T>
constexpr RadianceSh<T, 9> directional_light(T c, Vec3 d) {
    const ShBasis y = sh_basis(d);
    RadianceSh<T, 9> out;
    // The delta's strength is its irradiance on a facing plane: pi c.
    for (std::size_t i = 0; i < 9; ++i) out.c[i] = c * (3.14159265358979324f * y[i]);
    return out;
}

// Radiance c over the hemisphere about n: band 2 is zero.
template <class T>
constexpr RadianceSh<T, 9> hemisphere_light(T c, Vec3 n) {
    constexpr float kSqrtPi = 1.7724538509055160f, kHalfSqrt3Pi = 1.5349900619197327f;
    RadianceSh<T, 9> out;
    out.c[0] = c * kSqrtPi;
    out.c[1] = c * (-kHalfSqrt3Pi * n.y);
    out.c[2] = c * (kHalfSqrt3Pi * n.z);
    out.c[3] = c * (-kHalfSqrt3Pi * n.x);
    for (std::size_t i = 4; i < 9; ++i) out.c[i] = c * 0.0f;
    return out;
}

}  // namespace lumel
