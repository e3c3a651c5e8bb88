// Small vectors and the affine map. Plain data, constexpr where it can be; no SIMD types in the interface.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lumel {

struct Vec2 {
    float x = 0.0f, y = 0.0f;
    constexpr float& operator[](std::size_t i) { return i == 0 ? x : y; }
    constexpr float operator[](std::size_t i) const { return i == 0 ? x : y; }
    friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

struct Vec3 {
    float x = 0.0f, y = 0.0f, z = 0.0f;
    constexpr float& operator[](std::size_t i) { return i == 0 ? x : (i == 1 ? y : z); }
    constexpr float operator[](std::size_t i) const { return i == 0 ? x : (i == 1 ? y : z); }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

struct Vec4 {
    float x = 0.0f, y = 0.0f, z = 0.0f, w = 0.0f;
    friend constexpr bool operator==(const Vec4&, const Vec4&) = default;
};

constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator*(Vec2 a, float s) { return {a.x * s, a.y * s}; }
constexpr Vec2 operator*(float s, Vec2 a) { return a * s; }
constexpr Vec2 operator*(Vec2 a, Vec2 b) { return {a.x * b.x, a.y * b.y}; }
constexpr float dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
constexpr float cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline float length(Vec2 a) { return std::sqrt(dot(a, a)); }

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
constexpr Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
constexpr Vec3& operator*=(Vec3& a, float s) { return a = a * s; }
constexpr Vec3& operator*=(Vec3& a, Vec3 b) { return a = a * b; }
constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(Vec3 a) { return a / length(a); }
// `fallback` where `a` has no usable direction (zero, subnormal or non-finite length).
inline Vec3 normalize_or(Vec3 a, Vec3 fallback) {
    const float len = length(a);
    return len > 1e-30f && std::isfinite(len) ? a / len : fallback;
}
constexpr Vec3 min(Vec3 a, Vec3 b) { return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z}; }
constexpr Vec3 max(Vec3 a, Vec3 b) { return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z}; }
constexpr float max_component(Vec3 a) { return a.x > a.y ? (a.x > a.z ? a.x : a.z) : (a.y > a.z ? a.y : a.z); }
inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline bool is_finite(Vec2 a) { return std::isfinite(a.x) && std::isfinite(a.y); }

constexpr Vec4 operator+(Vec4 a, Vec4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
constexpr Vec4 operator*(Vec4 a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }

// Rec. 709 luminance of a linear colour.
constexpr float luminance(Vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

// x' = linear * x + translation; `linear` is stored by columns (the images of the axes).
struct Affine {
    std::array<Vec3, 3> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 translation{};
    friend constexpr bool operator==(const Affine&, const Affine&) = default;
};

constexpr Vec3 transform_vector(const Affine& m, Vec3 v) {
    return m.columns[0] * v.x + m.columns[1] * v.y + m.columns[2] * v.z;
}
constexpr Vec3 transform_point(const Affine& m, Vec3 p) { return transform_vector(m, p) + m.translation; }
constexpr Affine operator*(const Affine& a, const Affine& b) {
    return {{transform_vector(a, b.columns[0]), transform_vector(a, b.columns[1]), transform_vector(a, b.columns[2])},
            transform_point(a, b.translation)};
}
constexpr float determinant(const Affine& m) { return dot(m.columns[0], cross(m.columns[1], m.columns[2])); }
// The map of normals, inverse transpose times |determinant|: not normalised; keeps the outer side outer under mirrors.
constexpr Vec3 transform_normal(const Affine& m, Vec3 n) {
    const Vec3 v = cross(m.columns[1], m.columns[2]) * n.x + cross(m.columns[2], m.columns[0]) * n.y +
                   cross(m.columns[0], m.columns[1]) * n.z;
    return determinant(m) < 0.0f ? -v : v;
}

}  // namespace lumel
