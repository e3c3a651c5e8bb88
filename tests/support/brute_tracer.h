// The twin that ray tracers are tested against: every triangle for every ray, watertight, in double precision.
// Based on: Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection" (JCGT 2:1).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "trace/tracer.h"

namespace lumel::test {

class BruteTracer final : public Tracer {
public:
    BruteTracer(const WorldGeometry& geometry, SurfaceReader surfaces) : geometry_(geometry), surfaces_(surfaces) {
        for (std::size_t corner = 0; corner < 3; ++corner)
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const WorldTriangle& triangle : geometry.triangles)
                    corners_[3 * corner + axis].push_back(geometry.positions[triangle.vertices[corner]][axis]);
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        rays_ += rays.size();
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = trace(rays[i]);
    }
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
        rays_ += rays.size();
        for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = trace(rays[i]).missed() ? 0 : 1;
    }
    [[nodiscard]] TraceStatistics statistics() const override { return {rays_, invalid_, 0.0}; }
    [[nodiscard]] std::string_view description() const override { return "brute force"; }

private:
    // The ray as the z axis: which axes are which, and the shear that straightens it.
    struct Shear {
        std::array<double, 3> origin;
        std::size_t x, y, z;
        double sx, sy, sz;

        explicit Shear(const Ray& ray) : origin{ray.origin.x, ray.origin.y, ray.origin.z} {
            const std::array<double, 3> d{ray.direction.x, ray.direction.y, ray.direction.z};
            z = 0;
            for (std::size_t axis = 1; axis < 3; ++axis)
                if (std::fabs(d[axis]) > std::fabs(d[z])) z = axis;
            x = (z + 1) % 3;
            y = (z + 2) % 3;
            if (d[z] < 0) std::swap(x, y);
            sx = d[x] / d[z];
            sy = d[y] / d[z];
            sz = 1.0 / d[z];
        }
    };

    struct Candidate {
        double t = std::numeric_limits<double>::infinity(), b1 = 0, b2 = 0;
        bool back = false;
    };

    Hit trace(const Ray& ray) const {
        if (!is_traceable(ray)) {
            ++invalid_;
            return {};
        }
        const Shear shear(ray);
        std::vector<std::uint8_t> inside(geometry_.triangle_count());
        const Columns columns(*this, shear);
        find_candidates(columns, inside);
        Candidate best;
        std::uint32_t best_triangle = kNone;
        for (std::uint32_t triangle = 0; triangle < geometry_.triangle_count(); ++triangle) {
            if (triangle == ray.skip || inside[triangle] == 0) continue;
            const Edges edges = columns.edges(triangle);
            if (edges.determinant() == 0) continue;
            const Candidate candidate = edges.candidate(shear);
            if (candidate.t < ray.tmin || candidate.t > ray.tmax || candidate.t >= best.t) continue;
            if (!accepts(ray, triangle, candidate)) continue;
            best = candidate;
            best_triangle = triangle;
        }
        if (best_triangle == kNone) return {};
        const bool mirrored = (geometry_.triangles[best_triangle].flags & kMirrored) != 0;
        return {best_triangle, static_cast<float>(best.t), static_cast<float>(best.b1), static_cast<float>(best.b2),
                best.back != mirrored};
    }

    // The ray against the three edges, seen along the ray: all of one sign inside.
    struct Edges {
        double az, bz, cz, u, v, w;
        [[nodiscard]] double determinant() const { return u + v + w; }
        [[nodiscard]] bool inside() const {
            const double low = std::min(std::min(u, v), w), high = std::max(std::max(u, v), w);
            return (low >= 0) | (high <= 0);
        }
        [[nodiscard]] Candidate candidate(const Shear& s) const {
            const double det = determinant();
            return {(u * az + v * bz + w * cz) * s.sz / det, v / det, w / det, det < 0};
        }
    };

    // The corners' coordinates along the ray's axes x, y and z.
    struct Columns {
        const double *ax, *ay, *az, *bx, *by, *bz, *cx, *cy, *cz;
        double ox, oy, oz, sx, sy;

        Columns(const BruteTracer& tracer, const Shear& s)
            : ax(tracer.column(0, s.x)),
              ay(tracer.column(0, s.y)),
              az(tracer.column(0, s.z)),
              bx(tracer.column(1, s.x)),
              by(tracer.column(1, s.y)),
              bz(tracer.column(1, s.z)),
              cx(tracer.column(2, s.x)),
              cy(tracer.column(2, s.y)),
              cz(tracer.column(2, s.z)),
              ox(s.origin[s.x]),
              oy(s.origin[s.y]),
              oz(s.origin[s.z]),
              sx(s.sx),
              sy(s.sy) {}

        [[nodiscard]] Edges edges(std::size_t i) const {
            const double a = az[i] - oz, b = bz[i] - oz, c = cz[i] - oz;
            const double a_x = ax[i] - ox - sx * a, a_y = ay[i] - oy - sy * a;
            const double b_x = bx[i] - ox - sx * b, b_y = by[i] - oy - sy * b;
            const double c_x = cx[i] - ox - sx * c, c_y = cy[i] - oy - sy * c;
            return {a, b, c, c_x * b_y - c_y * b_x, a_x * c_y - a_y * c_x, b_x * a_y - b_y * a_x};
        }
    };

    [[nodiscard]] const double* column(std::size_t corner, std::size_t axis) const {
        return corners_[3 * corner + axis].data();
    }

    // A loop without branches, for compilers to turn into vector code: nearly all the time goes here.
    static void find_candidates(const Columns& columns, std::vector<std::uint8_t>& inside) {
        std::uint8_t* out = inside.data();
        const std::size_t count = inside.size();
        for (std::size_t i = 0; i < count; ++i) out[i] = columns.edges(i).inside();
    }

    bool accepts(const Ray& ray, std::uint32_t triangle, const Candidate& candidate) const {
        if ((geometry_.triangles[triangle].flags & kNeedsAlpha) == 0) return true;
        const float opacity =
            surfaces_.opacity(triangle, static_cast<float>(candidate.b1), static_cast<float>(candidate.b2));
        return stops_ray(opacity, ray.alpha_key, triangle);
    }

    const WorldGeometry& geometry_;
    SurfaceReader surfaces_;
    std::array<std::vector<double>, 9> corners_;  // a.x a.y a.z b.x ... c.z of every triangle
    mutable std::atomic<std::uint64_t> rays_{0}, invalid_{0};
};

}  // namespace lumel::test
