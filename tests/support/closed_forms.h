// Irradiance of simple lights at a point, exactly. E in the units of the light; divide by pi for I.
// Based on: Lambert 1760 (polygons); Howell, "A Catalog of Radiation Heat Transfer Configuration Factors" (B-12 disc,
// C-11 parallel rectangles); Snyder 1996 for the sphere cut by the horizon.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lumel/vec.h"

namespace lumel::closed_form {

inline constexpr double kPi = 3.14159265358979323846;

struct Vec {
    double x = 0, y = 0, z = 0;
    Vec() = default;
    Vec(double a, double b, double c) : x(a), y(b), z(c) {}
    Vec(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec unit(Vec a) { return a * (1.0 / length(a)); }

// An isotropic point of the given intensity (candela).
inline double point_light(Vec point, Vec normal, Vec position, double intensity) {
    const Vec to_light = position - point;
    const double d = length(to_light);
    return intensity * std::max(0.0, dot(to_light, normal)) / (d * d * d);
}

// KHR_lights_punctual's recommended factors.
inline double range_window(double distance, double range) {
    return range > 0 ? std::clamp(1.0 - std::pow(distance / range, 4), 0.0, 1.0) : 1.0;
}
inline double spot_factor(Vec spot_direction, Vec light_to_point, double inner, double outer) {
    const double scale = 1.0 / std::max(0.001, std::cos(inner) - std::cos(outer));
    const double a = std::clamp((dot(spot_direction, unit(light_to_point)) - std::cos(outer)) * scale, 0.0, 1.0);
    return a * a;
}

// A spherical cap of directions with radiance 1: half angle with sine s (at most a hemisphere), its axis at cosine c to
// the normal. Irradiance, with the part below the horizon cut.
inline double cap(double s, double c) {
    if (c >= s) return kPi * s * s * c;
    if (c <= -s) return 0.0;
    const double sine = std::sqrt(std::max(0.0, 1.0 - c * c));
    const double x = std::sqrt(1.0 / (s * s) - 1.0);
    const double y = std::clamp(-x * c / sine, -1.0, 1.0);
    const double r = std::sqrt(1.0 - y * y);
    return (c * std::acos(y) - x * r * sine) * s * s + std::atan2(r * sine, x);
}

// A sphere of uniform radiance seen from outside it, cut by the horizon.
inline double sphere_light(Vec point, Vec normal, Vec center, double radius, double radiance) {
    const Vec to_light = center - point;
    const double d = length(to_light);
    return radiance * cap(radius / d, dot(to_light, normal) / d);
}

// A sun of the given angular diameter and irradiance on a plane facing it.
inline double sun(Vec normal, Vec direction_to_sun, double angular_diameter, double irradiance) {
    const double c = dot(normal, direction_to_sun), s = std::sin(0.5 * angular_diameter);
    return s > 0 ? irradiance / (kPi * s * s) * cap(s, c) : irradiance * std::max(0.0, c);
}

// A polygon of uniform radiance. Its lit side is the one from which its corners run counter-clockwise; a point behind
// it gets nothing. The part below the horizon is cut.
inline double polygon_light(Vec point, Vec normal, const std::vector<Vec>& corners, double radiance) {
    std::vector<Vec> above;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
        const double ha = dot(a, normal), hb = dot(b, normal);
        if (ha >= 0) above.push_back(a);
        if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) above.push_back(a + (b - a) * (ha / (ha - hb)));
    }
    double sum = 0;
    for (std::size_t i = 0; i < above.size(); ++i) {
        const Vec a = above[i], b = above[(i + 1) % above.size()], c = cross(a, b);
        const double sine = length(c);
        if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(c, normal) / sine;
    }
    return std::max(0.0, -0.5 * radiance * sum);  // each cross product points down where the lit side is seen
}

// A rectangle or parallelogram by centre and half edges; lit on the side of half_u x half_v.
inline double rectangle_light(Vec point, Vec normal, Vec center, Vec u, Vec v, double radiance) {
    return polygon_light(point, normal, {center - u - v, center + u - v, center + u + v, center - u + v}, radiance);
}

// A disc parallel to the receiver (facing it) at height h, its centre at horizontal distance a.
inline double parallel_disc_light(double radius, double height, double offset, double radiance) {
    const double r2 = radius * radius, h2 = height * height, a2 = offset * offset;
    const double b = a2 + h2 + r2;
    return kPi * radiance * 0.5 * (1.0 - (a2 + h2 - r2) / std::sqrt(b * b - 4.0 * a2 * r2));
}

// A sky of radiance a + b d.y over the whole sphere, seen by a surface of normal n: cosine convolution of SH bands 0
// and 1.
inline double gradient_sky(Vec normal, double a, double b) { return kPi * a + 2.0 * kPi / 3.0 * b * normal.y; }

// Form factor between equal rectangles a x b, parallel and directly opposed at distance c.
inline double parallel_rectangles(double a, double b, double c) {
    const double x = a / c, y = b / c, x2 = 1 + x * x, y2 = 1 + y * y;
    return 2.0 / (kPi * x * y) *
           (0.5 * std::log(x2 * y2 / (x2 + y * y)) + x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
            y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y));
}

}  // namespace lumel::closed_form
