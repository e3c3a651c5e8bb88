// Random triangles of every size and place, rays that start on them, and occluders just above them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "math/frame.h"
#include "math/warp.h"
#include "support/world_builder.h"
#include "texel/ray_offset.h"
#include "trace/tracer.h"

namespace lumel::test {

enum class OffsetShape { any, corner_at_origin, level, near_corner, sliver };

struct OffsetCase {
    const char* name;
    float size;      // half edge of the cube that the corners are drawn from, metres
    float distance;  // half edge of the cube that those cubes are in
    OffsetShape shape = OffsetShape::any;
};

inline std::vector<OffsetCase> offset_cases() {
    std::vector<OffsetCase> cases{{"1 mm at the origin", 1e-3f, 0},
                                  {"1 cm at the origin", 1e-2f, 0},
                                  {"1 m at the origin", 1, 0},
                                  {"100 m at the origin", 100, 0},
                                  {"10 km at the origin", 1e4f, 0},
                                  {"1 mm within 1 m", 1e-3f, 1},
                                  {"1 mm within 1 km", 1e-3f, 1e3f},
                                  {"1 m within 10 km", 1, 1e4f},
                                  {"100 m within 10 km", 100, 1e4f},
                                  {"1 m with a corner at 0", 1, 0, OffsetShape::corner_at_origin},
                                  {"10 km with a corner at 0", 1e4f, 0, OffsetShape::corner_at_origin},
                                  {"10 m, level, at 0", 10, 0, OffsetShape::level},
                                  {"100 m near a corner", 100, 10, OffsetShape::near_corner},
                                  {"1 m slivers", 1, 0, OffsetShape::sliver},
                                  {"1 m slivers within 100 m", 1, 100, OffsetShape::sliver}};
    return cases;
}

inline World offset_world(const OffsetCase& c, std::uint32_t triangles, Random& random) {
    const auto in_cube = [&](float half_edge) {
        const float x = 2 * random.unit() - 1, y = 2 * random.unit() - 1, z = 2 * random.unit() - 1;
        return Vec3{x, y, z} * half_edge;
    };
    Mesh mesh;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const Vec3 center = in_cube(c.distance);
        std::array<Vec3, 3> p{center + in_cube(c.size), center + in_cube(c.size), center + in_cube(c.size)};
        switch (c.shape) {
            case OffsetShape::corner_at_origin: p[t % 3] = {}; break;
            case OffsetShape::level: p[0].y = p[1].y = p[2].y = 0; break;
            // Down to a thousandth as broad as long: the thinnest that the bound is for.
            case OffsetShape::sliver:
                p[2] = p[0] + (p[1] - p[0]) * random.unit() + in_cube(c.size * std::pow(10.0f, -2.0f * random.unit()));
                break;
            default: break;
        }
        const Vec3 e = p[1] - p[0], f = p[2] - p[0];
        const float longest = std::max({length(e), length(f), length(f - e)});
        if (0.5f * length(cross(e, f)) < 0x1p-11f * longest * longest) continue;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    WorldBuilder builder;
    builder.add_mesh(std::move(mesh));
    return builder.build();
}

inline Vec2 random_barycentrics(const OffsetCase& c, Random& random) {
    Vec2 b = UniformTriangle::sample(random.pair());
    if (c.shape != OffsetShape::near_corner && c.shape != OffsetShape::corner_at_origin) return b;
    // Towards a corner over six orders of magnitude.
    b = b * std::pow(10.0f, -6.0f * random.unit());
    switch (random.bits() % 3) {
        case 0: return b;
        case 1: return {1 - b.x - b.y, b.x};
        default: return {b.x, 1 - b.x - b.y};
    }
}

// A plane through float points, in double.
class Plane {
public:
    Plane(Vec3 p0, Vec3 p1, Vec3 p2) : p_{p0.x, p0.y, p0.z} {
        const double ux = double{p1.x} - p0.x, uy = double{p1.y} - p0.y, uz = double{p1.z} - p0.z;
        const double vx = double{p2.x} - p0.x, vy = double{p2.y} - p0.y, vz = double{p2.z} - p0.z;
        n_ = {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
        length_ = std::sqrt(n_[0] * n_[0] + n_[1] * n_[1] + n_[2] * n_[2]);
    }
    [[nodiscard]] bool defined() const { return length_ > 0; }
    [[nodiscard]] double height(Vec3 q) const {
        return ((q.x - p_[0]) * n_[0] + (q.y - p_[1]) * n_[1] + (q.z - p_[2]) * n_[2]) / length_;
    }

private:
    std::array<double, 3> p_, n_{};
    double length_ = 0;
};

struct OffsetCount {
    std::uint64_t rays = 0, self_hits = 0, occluders = 0, missed_occluders = 0;
    std::string first_failure;
};

// Rays into the hemisphere of either side, half of them grazing (cosine below 1/1000). For self hits the triangles of a
// case are one scene and a ray ends before it can meet another one by more than chance; only its own counts. Then each
// triangle again, moved off by four offsets to either side, must stop a ray straight at it.
inline OffsetCount trace_offset_rays(std::uint32_t triangles, std::uint32_t rays_per_triangle, std::uint64_t seed) {
    OffsetCount count;
    Random random(seed);
    Context context(1);
    for (const OffsetCase& c : offset_cases()) {
        const World world = offset_world(c, triangles, random);
        const WorldGeometry& geometry = world.geometry;
        Mesh lids;
        std::vector<Ray> rays, up;
        std::vector<std::uint32_t> start;
        for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
            for (std::uint32_t i = 0; i < rays_per_triangle; ++i) {
                const Vec2 b = random_barycentrics(c, random), u = random.pair();
                const Vec3 n = geometry.geometric_normal(t) * (i % 2 == 0 ? 1.0f : -1.0f);
                const float cosine = i % 4 < 2 ? u.x : 1e-3f * u.x;
                const Vec3 d = normalize(Frame(n).to_world(direction_from_z(cosine, u.y)));
                if (!(dot(d, n) > 0.0f)) continue;
                rays.push_back({offset_origin(geometry, t, b.x, b.y, n), 0, d, 0.01f * c.size});
                start.push_back(t);
            }
            // One lid per triangle; its ray starts well inside. Triangles that are no broader than a few offsets are
            // only a few floats across: there the ray may pass beside the lid.
            const Vec3 n = geometry.geometric_normal(t) * (t % 2 == 0 ? 1.0f : -1.0f);
            const Vec3 origin = offset_origin(geometry, t, 0.3f, 0.3f, n);
            const float offset = plane_error(geometry, t, 0.3f, 0.3f, n) + geometry.triangles[t].tracer_error;
            const auto [p0, p1, p2] = geometry.corners(t);
            const float longest = std::max({length(p1 - p0), length(p2 - p0), length(p2 - p1)});
            if (2.0f * geometry.area(t) / longest < 16.0f * offset) continue;
            const auto first = static_cast<std::uint32_t>(lids.positions.size());
            for (const Vec3 p : geometry.corners(t)) lids.positions.push_back(p + n * (4.0f * offset));
            lids.triangles.push_back({first, first + 1, first + 2});
            up.push_back({origin, 0, n, 8.0f * offset});
        }
        const auto tracer = make_embree_tracer(geometry, world.surfaces(), context);
        if (!tracer.ok()) {
            ADD_FAILURE() << tracer.error().text();
            return count;
        }
        std::vector<Hit> hits(rays.size());
        (*tracer)->closest(rays, hits);
        count.rays += rays.size();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (hits[i].triangle != start[i]) continue;
            if (count.self_hits++ == 0)
                count.first_failure = std::string(c.name) + ", triangle " + std::to_string(start[i]);
        }
        // Each lid alone: others may be in the way.
        for (std::uint32_t t = 0; t < up.size(); t += 4) {
            WorldBuilder one;
            Mesh lid;
            for (const std::uint32_t v : lids.triangles[t]) lid.positions.push_back(lids.positions[v]);
            lid.triangles = {{0, 1, 2}};
            one.add_mesh(std::move(lid));
            const World lid_world = one.build();
            const auto lid_tracer = make_embree_tracer(lid_world.geometry, lid_world.surfaces(), context);
            std::uint8_t blocked = 0;
            (*lid_tracer)->occluded({&up[t], 1}, {&blocked, 1});
            ++count.occluders;
            if (blocked == 0 && count.missed_occluders++ == 0)
                count.first_failure = std::string(c.name) + ", lid of triangle " + std::to_string(t);
        }
    }
    return count;
}

}  // namespace lumel::test
