// SH coefficients of incident radiance and of irradiance: different types, so that neither is evaluated as the other.
// T is float or Vec3 (RGB); N is 4 (linear) or 9 (quadratic). Basis S (basis.h).
// Based on: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps" (the cosine
// bands). We differ in that the bands are those of I = E/pi, the radiance that a white Lambertian surface sends out.
#pragma once

#include <array>
#include <cstddef>

#include "sh/basis.h"

namespace lumel {

template <class T, std::size_t N>
struct RadianceSh {
    static_assert(N == 4 || N == 9);
    std::array<T, N> c{};
};

// Of I = E/pi, cosine bands already applied: I(n) = sum of c_i Y_i(n).
template <class T, std::size_t N>
struct IrradianceSh {
    static_assert(N == 4 || N == 9);
    std::array<T, N> c{};
};

// The cosine lobe's bands for I: 1, 2/3, 1/4 (for E they are times pi).
inline constexpr std::array<float, 3> kCosineBands{1.0f, 2.0f / 3.0f, 0.25f};
constexpr std::size_t band_of(std::size_t i) { return i == 0 ? 0 : (i < 4 ? 1 : 2); }

template <class T, std::size_t N>
constexpr T dot_basis(const std::array<T, N>& c, const ShBasis& y) {
    T sum = c[0] * y[0];
    for (std::size_t i = 1; i < N; ++i) sum = sum + c[i] * y[i];
    return sum;
}

// Radiance arriving from unit direction w, as far as the bands carry it (it may ring below zero).
template <class T, std::size_t N>
constexpr T evaluate(const RadianceSh<T, N>& sh, Vec3 w) {
    return dot_basis(sh.c, sh_basis(w));
}

// I = E/pi of a surface with unit normal n.
template <class T, std::size_t N>
constexpr T evaluate(const IrradianceSh<T, N>& sh, Vec3 n) {
    return dot_basis(sh.c, sh_basis(n));
}

template <class T, std::size_t N>
constexpr IrradianceSh<T, N> convolve_cosine(const RadianceSh<T, N>& radiance) {
    IrradianceSh<T, N> out;
    for (std::size_t i = 0; i < N; ++i) out.c[i] = radiance.c[i] * kCosineBands[band_of(i)];
    return out;
}

template <class T>
constexpr RadianceSh<T, 4> linear_part(const RadianceSh<T, 9>& sh) {
    return {{sh.c[0], sh.c[1], sh.c[2], sh.c[3]}};
}

// Monte-Carlo projection: the mean over samples of this is the coefficients of the sampled radiance. The sphere or
// hemisphere is in the pdf (1/4pi, 1/2pi, cos/pi), nowhere else.
template <std::size_t N, class T>
constexpr RadianceSh<T, N> project_sample(T radiance, Vec3 w, float pdf_solid_angle) {
    const ShBasis y = sh_basis(w);
    RadianceSh<T, N> out;
    for (std::size_t i = 0; i < N; ++i) out.c[i] = radiance * (y[i] / pdf_solid_angle);
    return out;
}

}  // namespace lumel
