// Whether two tracers agree on random rays, up to rays that pass through an edge or meet two surfaces at once.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/warp.h"
#include "support/statistics.h"
#include "trace/tracer.h"

namespace lumel::test {

// Origins uniform in the bounds, directions uniform over the sphere.
inline std::vector<Ray> random_rays(const WorldGeometry& geometry, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    const Vec3 size = geometry.bounds_max - geometry.bounds_min;
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        const float x = random.unit(), y = random.unit(), z = random.unit();
        ray.origin = geometry.bounds_min + size * Vec3{x, y, z};
        const Vec2 u = random.pair();
        ray.direction = normalize(direction_from_z(1.0f - 2.0f * u.x, u.y));
    }
    return rays;
}

// Smallest barycentric: how near the hit lies to an edge of its triangle.
inline float edge_distance(const Hit& hit) {
    return hit.missed() ? 1.0f : std::min({std::fabs(hit.b1), std::fabs(hit.b2), std::fabs(1.0f - hit.b1 - hit.b2)});
}

// At least 99.999 % the same triangle at the same place; each of the rest within 1e-5 of an edge or of a tie.
inline ::testing::AssertionResult tracers_agree(const Tracer& tested, const Tracer& truth,
                                                const WorldGeometry& geometry, std::size_t count, std::uint64_t seed) {
    const std::vector<Ray> rays = random_rays(geometry, count, seed);
    std::vector<Hit> a(count), b(count);
    tested.closest(rays, a);
    truth.closest(rays, b);
    const float scale = length(geometry.bounds_max - geometry.bounds_min);
    std::size_t hits = 0, other_triangle = 0;
    double worst_t = 0, worst_barycentric = 0;
    for (std::size_t i = 0; i < count; ++i) {
        hits += b[i].missed() ? 0 : 1;
        if (a[i].triangle != b[i].triangle) {
            ++other_triangle;
            // Of two hits, or of a hit and the ray's start.
            const bool tie = (!a[i].missed() && !b[i].missed() && std::fabs(a[i].t - b[i].t) <= 1e-5f * scale) ||
                             std::min(a[i].t, b[i].t) - rays[i].tmin <= 1e-5f * scale;
            if (!tie && std::min(edge_distance(a[i]), edge_distance(b[i])) > 1e-5f)
                return ::testing::AssertionFailure()
                       << "ray " << i << ": triangle " << a[i].triangle << " at " << a[i].t << " instead of "
                       << b[i].triangle << " at " << b[i].t << ", neither an edge nor a tie";
        } else if (!a[i].missed()) {
            if (a[i].back_face != b[i].back_face) return ::testing::AssertionFailure() << "ray " << i << ": other side";
            // Grazing rays lose digits: an error of the plane distance is divided by the cosine.
            const float cosine = std::fabs(dot(rays[i].direction, geometry.geometric_normal(a[i].triangle)));
            worst_t = std::max(worst_t, double{std::fabs(a[i].t - b[i].t) * cosine / scale});
            const auto [p, q, r] = geometry.corners(a[i].triangle);
            const float height =
                2.0f * geometry.area(a[i].triangle) / std::max({length(q - p), length(r - p), length(r - q)});
            const float error = std::max(std::fabs(a[i].b1 - b[i].b1), std::fabs(a[i].b2 - b[i].b2));
            worst_barycentric = std::max(worst_barycentric, double{error * height * cosine / scale});
        }
    }
    if (hits < count / 10) return ::testing::AssertionFailure() << "only " << hits << " rays hit anything";
    ::testing::Test::RecordProperty("other_triangle", static_cast<int>(other_triangle));
    if (static_cast<double>(other_triangle) > 1e-5 * static_cast<double>(count) + 0.5)
        return ::testing::AssertionFailure() << other_triangle << " of " << count << " rays meet another triangle";
    // A few roundings of single precision, relative to the size of the scene.
    if (worst_t > 1e-6 || worst_barycentric > 1e-6)
        return ::testing::AssertionFailure() << "t differs by " << worst_t << ", barycentrics by " << worst_barycentric;
    return ::testing::AssertionSuccess() << other_triangle << " of " << count << " rays differ";
}

}  // namespace lumel::test
