// Rotation of SH to band 2 by two 3x3 products instead of a 9x9 matrix: band 1 is a vector, band 2 a traceless
// symmetric matrix Q with f2(w) = (k2/2) w'Qw. Exact; about 60 multiply-adds per channel. Based on: the Cartesian form
// of band 2 (Ramamoorthi and Hanrahan 2001, eq. 12, without its constant term).
#pragma once

#include <array>

#include "sh/coefficients.h"

namespace lumel {

// Rows are the axes of the new frame, given in the old one: (T, B, N) for world to tangent space.
using Rotation = std::array<Vec3, 3>;

// Band 1 as a vector along which light comes: v = (-l3, -l1, l2) = 4 pi k1 * mean of radiance times direction.
template <class T>
struct ShVector {
    T x, y, z;
};

template <class T, std::size_t N>
constexpr ShVector<T> linear_vector(const std::array<T, N>& l) {
    return {l[3] * -1.0f, l[1] * -1.0f, l[2]};
}

// Upper triangle of Q; zz = -xx - yy.
template <class T>
struct ShMatrix {
    T xx, xy, xz, yy, yz, zz;
};

inline constexpr float kInvSqrt3 = 0.57735026918962576f;
inline constexpr float kHalfSqrt3 = 0.86602540378443865f;

template <class T>
constexpr ShMatrix<T> quadratic_matrix(const std::array<T, 9>& l) {
    const T l6 = l[6] * kInvSqrt3;
    return {l[8] + l6 * -1.0f, l[4], l[7] * -1.0f, (l6 + l[8]) * -1.0f, l[5] * -1.0f, l6 * 2.0f};
}

namespace detail {

template <class T>
constexpr T row_times(Vec3 row, const ShVector<T>& v) {
    return v.x * row.x + v.y * row.y + v.z * row.z;
}

template <class T>
constexpr ShVector<T> matrix_times(const ShMatrix<T>& q, Vec3 v) {
    return {q.xx * v.x + q.xy * v.y + q.xz * v.z, q.xy * v.x + q.yy * v.y + q.yz * v.z,
            q.xz * v.x + q.yz * v.y + q.zz * v.z};
}

template <class T, std::size_t N>
constexpr std::array<T, N> rotate(const std::array<T, N>& l, const Rotation& r) {
    std::array<T, N> out{};
    out[0] = l[0];
    const ShVector<T> v = linear_vector(l);
    out[1] = row_times(r[1], v) * -1.0f;
    out[2] = row_times(r[2], v);
    out[3] = row_times(r[0], v) * -1.0f;
    if constexpr (N == 9) {
        const ShMatrix<T> q = quadratic_matrix(l);
        const ShVector<T> qx = matrix_times(q, r[0]), qy = matrix_times(q, r[1]), qz = matrix_times(q, r[2]);
        out[4] = row_times(r[0], qy);
        out[5] = row_times(r[1], qz) * -1.0f;
        out[6] = row_times(r[2], qz) * kHalfSqrt3;
        out[7] = row_times(r[0], qz) * -1.0f;
        out[8] = (row_times(r[0], qx) + row_times(r[1], qy) * -1.0f) * 0.5f;
    }
    return out;
}

}  // namespace detail

template <class T, std::size_t N>
constexpr RadianceSh<T, N> rotate(const RadianceSh<T, N>& sh, const Rotation& world_to_frame) {
    return {detail::rotate(sh.c, world_to_frame)};
}

template <class T, std::size_t N>
constexpr IrradianceSh<T, N> rotate(const IrradianceSh<T, N>& sh, const Rotation& world_to_frame) {
    return {detail::rotate(sh.c, world_to_frame)};
}

}  // namespace lumel
