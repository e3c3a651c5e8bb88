#include "light/sky_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/constants.h"
#include "math/trig.h"

namespace lumel {

Vec3 sky_direction(float u, float v) {
    const SinCos azimuth = sincos_turn(u - 0.5f);
    const SinCos latitude = sincos_turn(0.25f - 0.5f * v);
    return {latitude.cosine * azimuth.cosine, latitude.sine, latitude.cosine * azimuth.sine};
}

Vec2 sky_coordinates(Vec3 direction) {
    const double azimuth = arctangent2(direction.z, direction.x);
    // Not the arc sine of y, which has few digits at the poles.
    const double horizontal = std::sqrt(double{direction.x} * direction.x + double{direction.z} * direction.z);
    const double latitude = arctangent2(direction.y, horizontal);
    return {std::clamp(static_cast<float>(azimuth * kInvTwoPi + 0.5), 0.0f, 1.0f),
            std::clamp(static_cast<float>(0.5 - latitude * kInvPi), 0.0f, 1.0f)};
}

Vec3 lookup(const SkyMap& map, Vec2 uv) {
    const float x = uv.x * static_cast<float>(map.width) - 0.5f, y = uv.y * static_cast<float>(map.height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const float fx = x - left, fy = y - top;
    const auto width = static_cast<std::int64_t>(map.width), height = static_cast<std::int64_t>(map.height);
    const auto x0 = (static_cast<std::int64_t>(left) + width) % width, x1 = (x0 + 1) % width;
    const auto y0 = std::clamp<std::int64_t>(static_cast<std::int64_t>(top), 0, height - 1);
    const auto y1 = std::clamp<std::int64_t>(static_cast<std::int64_t>(top) + 1, 0, height - 1);
    const auto at = [&](std::int64_t px, std::int64_t py) {
        return map.radiance[static_cast<std::size_t>(py * width + px)];
    };
    return (at(x0, y0) * (1 - fx) + at(x1, y0) * fx) * (1 - fy) + (at(x0, y1) * (1 - fx) + at(x1, y1) * fx) * fy;
}

Vec3 lookup(const SkyMap& map, Vec3 direction) { return lookup(map, sky_coordinates(direction)); }

std::vector<double> row_edge_sines(std::uint32_t height) {
    std::vector<double> sines(height + 1);
    for (std::uint32_t y = 0; y <= height; ++y)
        sines[y] = sincos_radians(0.5 * std::numbers::pi * (1.0 - 2.0 * y / height)).sine;
    return sines;
}

std::array<double, 3> integrate(const SkyMap& map) {
    const std::vector<double> sines = row_edge_sines(map.height);
    std::array<double, 3> total{};
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const double solid_angle = (sines[y] - sines[y + 1]) * (2.0 * std::numbers::pi) / map.width;
        std::array<double, 3> row{};
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const Vec3 c = map.radiance[std::size_t{y} * map.width + x];
            row[0] += c.x, row[1] += c.y, row[2] += c.z;
        }
        for (std::size_t k = 0; k < 3; ++k) total[k] += row[k] * solid_angle;
    }
    return total;
}

}  // namespace lumel
