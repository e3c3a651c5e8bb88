// SH and hemispheres: Gram matrices, products with a hemisphere or a cone, and the irradiance of what shines from above
// a surface only. Based on: Roughton 2024, "Hemispherical Lighting Insights" (Gram matrices, multiplies, HLSH; where
// its slides and these formulas differ, the tests integrate numerically). Different here: band 2 as a matrix (rotate.h)
// instead of 3x5 tables; kIrradianceFit.
#pragma once

#include <array>
#include <cmath>

#include "math/constants.h"
#include "sh/rotate.h"
#include "sh/zonal.h"

namespace lumel {

// A symmetric 9x9 matrix that does not tell directions around +z apart: its entries by index; 33 = 11, 37 = 15, 77 =
// 55, 88 = 44, all others are zero.
struct ZonalMatrix {
    float m00, m02, m06, m11, m15, m22, m26, m44, m55, m66;
};

template <class T>
constexpr std::array<T, 9> multiply(const ZonalMatrix& m, const std::array<T, 9>& l) {
    return {l[0] * m.m00 + l[2] * m.m02 + l[6] * m.m06,
            l[1] * m.m11 + l[5] * m.m15,
            l[0] * m.m02 + l[2] * m.m22 + l[6] * m.m26,
            l[3] * m.m11 + l[7] * m.m15,
            l[4] * m.m44,
            l[1] * m.m15 + l[5] * m.m55,
            l[0] * m.m06 + l[2] * m.m26 + l[6] * m.m66,
            l[3] * m.m15 + l[7] * m.m55,
            l[8] * m.m44};
}

inline constexpr ZonalMatrix kIdentityMatrix{1, 0, 0, 1, 0, 1, 0, 1, 1, 1};

// Integral of Y Y' over the cone about +z whose half angle has cosine c; c = -1 is the sphere. Multiplying radiance
// coefficients by it gives those of the radiance inside the cone alone.
constexpr ZonalMatrix cone_gram(double c) {
    constexpr double kSqrt3 = 1.7320508075688772, kSqrt5 = 2.2360679774997897, kSqrt15 = 3.8729833462074169;
    const double c2 = c * c, c3 = c2 * c, c4 = c2 * c2, c5 = c4 * c;
    const auto f = [](double x) { return static_cast<float>(x); };
    return {f((1 - c) / 2),
            f(kSqrt3 / 4 * (1 - c2)),
            f(kSqrt5 / 4 * (c - c3)),
            f((2 - 3 * c + c3) / 4),
            f(3 * kSqrt5 / 16 * (1 - c2) * (1 - c2)),
            f((1 - c3) / 2),
            f(kSqrt15 / 16 * (1 + 2 * c2 - 3 * c4)),
            f((8 - 15 * c + 10 * c3 - 3 * c5) / 16),
            f((2 - 5 * c3 + 3 * c5) / 4),
            f((4 - 5 * c + 10 * c3 - 9 * c5) / 8)};
}
inline constexpr ZonalMatrix kHemisphereGram = cone_gram(0.0);

template <class T>
constexpr T dot_coefficients(const std::array<float, 9>& a, const std::array<T, 9>& b) {
    T sum = b[0] * a[0];
    for (std::size_t i = 1; i < 9; ++i) sum = sum + b[i] * a[i];
    return sum;
}

// K = G^-1 B G^-1 with G the Gram matrix of the hemisphere H and B = integral over n and w in H of
// Y(n) max(n.w, 0)/pi Y(w)'. Light that shines from H alone is known better than its nine coefficients say at first
// sight: the cosine lobe, too, is needed over H alone, and there a quadratic polynomial fits it more closely than the
// sphere's bands 1, 2/3, 1/4 do. K does that, and fits the result over the normals in H; it amplifies noise no more
// than the bands do. Values from spectral quadrature over lunes.
inline constexpr ZonalMatrix kIrradianceFit{
    -0.4009020636879759f, 1.6176223671573882f, -0.7831280610565958f, 0.6182942095034591f,
    0.04056153842085568f, -1.201202751585679f, 0.9042783937226274f,  0.25f,
    0.2159881160571289f,  -0.1877818949026371f};

// I = E/pi over the normals of the upper hemisphere, as the quadratic polynomial nearest to it, from radiance of the
// tangent frame (n_v = +z) that is zero below the horizon.
template <class T>
constexpr IrradianceSh<T, 9> fit_irradiance(const RadianceSh<T, 9>& radiance) {
    return {multiply(kIrradianceFit, radiance.c)};
}

// Products in the world frame
// ----------------------------------------------------------------------------------------

// The part of band 2 that is linear in the directions across n, in the order of coefficients 1..3.
template <class T>
constexpr std::array<T, 3> tangent_quadratic(const RadianceSh<T, 9>& radiance, Vec3 n) {
    const ShVector<T> q = detail::matrix_times(quadratic_matrix(radiance.c), n);
    const T along = detail::row_times(n, q);
    return {(q.y + along * -n.y) * -1.0f, q.z + along * -n.z, (q.x + along * -n.x) * -1.0f};
}

// Unit vector n as it pairs with coefficients 1..3.
constexpr std::array<float, 3> linear_direction(Vec3 n) { return {-n.y, n.z, -n.x}; }

// Radiance restricted to the hemisphere about n, projected to linear SH.
template <class T>
constexpr RadianceSh<T, 4> multiply_hemisphere_linear(const RadianceSh<T, 9>& radiance, Vec3 n) {
    constexpr float kSqrt3Over4 = 0.43301270189221932f, kHalfSqrt3Pi = 1.5349900619197327f;
    constexpr float k3Sqrt5Over16 = 0.41926274578121059f;
    const T zonal = detail::row_times(n, linear_vector(radiance.c));
    const T iz = evaluate(convolve_cosine(radiance), n);
    const std::array<T, 3> p2 = tangent_quadratic(radiance, n);
    const std::array<float, 3> d = linear_direction(n);
    RadianceSh<T, 4> out;
    out.c[0] = radiance.c[0] * 0.5f + zonal * kSqrt3Over4;
    for (std::size_t k = 0; k < 3; ++k)
        out.c[k + 1] = iz * (kHalfSqrt3Pi * d[k]) + (radiance.c[k + 1] + zonal * -d[k]) * 0.5f + p2[k] * k3Sqrt5Over16;
    return out;
}

// I(n) = ambient + linear.n over the upper hemisphere, exact at n_v: linear.n_v = iz - ambient.
template <class T>
struct HemisphereLinear {
    T iz, ambient;
    ShVector<T> linear;
};

// Radiance restricted to the cone about n whose half angle has cosine c (0: the hemisphere).
template <class T>
constexpr HemisphereLinear<T> multiply_cone(const RadianceSh<T, 9>& radiance, Vec3 n, float c) {
    constexpr float kSqrtPi = 1.7724538509055160f, kSqrt3 = 1.7320508075688772f;
    constexpr float kSqrt5 = 2.2360679774997897f, kSqrt15 = 3.8729833462074169f;
    const float c2 = c * c, c3 = c2 * c, c4 = c2 * c2, c5 = c4 * c, c6 = c3 * c3, c7 = c6 * c;
    const std::array<T, 3> z = zonal_coefficients(radiance, n);
    HemisphereLinear<T> out;
    out.iz =
        z[0] * ((1 - c2) * kSh0) + z[1] * (2.0f / 3 * (1 - c3) * kSh1) + z[2] * (0.5f * kSh20 * (1 + 2 * c2 - 3 * c4));
    out.ambient =
        z[0] * ((1024 - 1767 * c + 512 * c2 + 210 * c3 + 21 * c5) / (4096 * kSqrtPi)) +
        z[1] * ((2203 - 5301 * c2 + 2048 * c3 + 945 * c4 + 105 * c6) / (8192 * kSqrt3 * kSqrtPi)) +
        z[2] * (kSqrt5 * (-448 + 1767 * c - 512 * c2 - 1977 * c3 + 768 * c4 + 357 * c5 + 45 * c7) / (8192 * kSqrtPi));
    const float k1 = (1 - c) * (1 - c) * (2573 + 2074 * c + 630 * c2 + 210 * c3 + 105 * c4) / (4096 * kSqrt3 * kSqrtPi);
    const float k2 = kSqrt15 * (176 - 256 * c2 - 105 * c3 + 128 * c4 + 42 * c5 + 15 * c7) / (2048 * kSqrtPi);
    const std::array<T, 3> p2 = tangent_quadratic(radiance, n);
    const std::array<float, 3> d = linear_direction(n);
    std::array<T, 3> sh;
    for (std::size_t k = 0; k < 3; ++k)
        sh[k] = (radiance.c[k + 1] + z[1] * -d[k]) * k1 + p2[k] * k2 + (out.iz + out.ambient * -1.0f) * d[k];
    out.linear = {sh[2] * -1.0f, sh[0] * -1.0f, sh[1]};
    return out;
}

// Cosine of the half angle of the cone that has cosine-weighted visibility v about a direction at cosine z from n_v;
// 0, the hemisphere, where no cone above the horizon is that open.
inline float cone_cosine(float visibility, float z) { return visibility < z ? std::sqrt(1.0f - visibility / z) : 0.0f; }

}  // namespace lumel
