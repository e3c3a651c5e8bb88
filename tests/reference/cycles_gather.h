// Where Blender Cycles 3.4 gathers the light of a lightmap's texel, as far as that is not where Lumel does.
//
// Both take the middle half of the texel. Cycles knows it as one triangle, that of the texel's centre, and as
// barycentric coordinates on it, u of the first corner and v of the second; a point that falls off that triangle is
// mirrored back onto it: first u about 0 and 1, then v about 0 and 1 - u (`bake_clamp_mirror_repeat` of its bake
// kernel). At a diagonal of a quad half of the texel is folded over; in a long thin triangle, where a quarter of a
// texel is much of v, points land many texels away. That is an error of the reference where a shadow is near, and no
// noise.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "image/image.h"
#include "lumel/scene.h"

namespace lumel::test {

// `x` mirrored about 0 and `most` until it lies between them.
inline double mirror_repeat(double x, double most) {
    if (most <= 0.0) return 0.0;
    const double t = std::fmod(std::fabs(x / most), 2.0);
    return (t > 1.0 ? 2.0 - t : t) * most;
}

// What Cycles adds to each texel of a page of size x size: the light of its mirrored points less that of the middle
// half, both read from `fine`, the same light in `fine.width / size` times the resolution (a multiple of 4). RGB; 0
// where no point is mirrored, or no triangle has the texel's centre.
inline Image light_of_mirrored_points(const Scene& scene, const Image& fine, std::uint32_t size) {
    const std::uint32_t factor = fine.width / size, points = 2 * factor;  // points per side
    Image added(size, size, 3);
    struct Corner {
        double x, y;
    };
    const auto read = [&](double x, double y, std::size_t c) {
        const auto at = [&](double t) {
            return static_cast<std::uint32_t>(std::clamp(t * factor, 0.0, static_cast<double>(fine.width - 1)));
        };
        return static_cast<double>(fine.data[(std::size_t{at(y)} * fine.width + at(x)) * 3 + c]);
    };
    const auto add_triangle = [&](const std::array<Corner, 3>& t) {
        const double a = t[0].x - t[2].x, b = t[1].x - t[2].x, c = t[0].y - t[2].y, d = t[1].y - t[2].y;
        const double area = a * d - b * c;
        if (area == 0.0) return;
        const auto u_of = [&](double x, double y) { return (d * (x - t[2].x) - b * (y - t[2].y)) / area; };
        const auto v_of = [&](double x, double y) { return (a * (y - t[2].y) - c * (x - t[2].x)) / area; };
        const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
        const auto first = [](double x) { return static_cast<std::uint32_t>(std::max(0.0, std::floor(x))); };
        for (std::uint32_t y = first(top); y < std::min<double>(size, bottom); ++y)
            for (std::uint32_t x = first(left); x < std::min<double>(size, right); ++x) {
                // Blender moves what it rasterises by a thousandth, so that no centre lies on a diagonal.
                const double cx = x + 0.501, cy = y + 0.498;
                const double cu = u_of(cx, cy), cv = v_of(cx, cy);
                if (cu < 0.0 || cv < 0.0 || cu + cv > 1.0) continue;
                std::array<double, 3> difference{};
                for (std::uint32_t k = 0; k < points * points; ++k) {
                    const double px = cx + ((k % points) + 0.5) / (2.0 * points) - 0.25;
                    const double py = cy + ((k / points) + 0.5) / (2.0 * points) - 0.25;
                    const double u = mirror_repeat(u_of(px, py), 1.0), v = mirror_repeat(v_of(px, py), 1.0 - u);
                    const double w = 1.0 - u - v;
                    const double mx = u * t[0].x + v * t[1].x + w * t[2].x, my = u * t[0].y + v * t[1].y + w * t[2].y;
                    if (std::fabs(mx - px) + std::fabs(my - py) < 1e-3) continue;
                    for (std::size_t c3 = 0; c3 < 3; ++c3) difference[c3] += read(mx, my, c3) - read(px, py, c3);
                }
                for (std::size_t c3 = 0; c3 < 3; ++c3)
                    added.data[(std::size_t{y} * size + x) * 3 + c3] =
                        static_cast<float>(difference[c3] / (points * points));
            }
    };
    for (const auto& mesh : scene.meshes)
        if (!mesh->uv1.empty())
            for (const Triangle& triangle : mesh->triangles) {
                std::array<Corner, 3> corners{};
                for (std::size_t k = 0; k < 3; ++k)
                    corners[k] = {double{mesh->uv1[triangle[k]].x} * size, double{mesh->uv1[triangle[k]].y} * size};
                add_triangle(corners);
            }
    return added;
}

}  // namespace lumel::test
