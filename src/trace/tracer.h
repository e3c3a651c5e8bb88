// Ray queries against the world geometry. `embree_tracer.cpp` is the back end; `brute_tracer.h` its twin in tests.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>

#include "lumel/context.h"
#include "lumel/result.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"

namespace lumel {

// Precondition: all finite, direction of unit length, 0 <= tmin < tmax. Rays that break it are never handed to the
// back end (an Embree with assertions aborts on them): they count as misses, unblocked, and as `invalid` in the
// statistics.
struct Ray {
    Vec3 origin;
    float tmin = 0.0f;
    Vec3 direction;
    float tmax = 1e30f;
    std::uint32_t skip = kNone;   // a triangle that this ray cannot hit: the one it starts on
    std::uint32_t alpha_key = 0;  // random key of this ray: BLEND surfaces stop it with probability alpha
};

struct Hit {
    std::uint32_t triangle = kNone;  // kNone: nothing within [tmin, tmax]
    float t = 0.0f;
    float b1 = 0.0f, b2 = 0.0f;  // barycentrics of corners 1 and 2
    bool back_face = false;      // the ray came from behind the front face
    [[nodiscard]] bool missed() const { return triangle == kNone; }
};

// Totals since construction, summed over threads; read when no query runs.
struct TraceStatistics {
    std::uint64_t rays = 0;     // asked for, the invalid ones too
    std::uint64_t invalid = 0;  // rays that broke the precondition
    double seconds = 0.0;       // inside the back end's calls, summed over threads
};

// Whether a ray keeps the precondition above.
inline bool is_traceable(const Ray& ray) {
    // Far inside the range where squared distances stay finite; a comparison with NaN is false.
    constexpr float kLargestCoordinate = 1e18f;
    const bool origin = std::fabs(ray.origin.x) <= kLargestCoordinate &&
                        std::fabs(ray.origin.y) <= kLargestCoordinate && std::fabs(ray.origin.z) <= kLargestCoordinate;
    const float squared_length = dot(ray.direction, ray.direction);
    const bool direction = squared_length > 0.999f && squared_length < 1.001f;
    return origin && direction && ray.tmin >= 0.0f && ray.tmin < ray.tmax && std::isfinite(ray.tmax);
}

class Tracer {
public:
    virtual ~Tracer() = default;

    // Nearest hit of each ray that the alpha rule accepts; of equally near ones that of the lowest triangle id. Spans
    // of equal size. Thread-safe; results do not depend on the batch: batching is for speed alone.
    virtual void closest(std::span<const Ray> rays, std::span<Hit> hits) const = 0;

    // blocked[i] = 1 if anything lies within [tmin, tmax], else 0.
    virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const = 0;

    [[nodiscard]] virtual TraceStatistics statistics() const = 0;
    [[nodiscard]] virtual std::string_view description() const = 0;  // "Embree 3.13.5, isa avx2"
};

// Borrows geometry and surfaces for its lifetime. Stage "acceleration". Errors: out_of_memory, cancelled.
Result<std::unique_ptr<Tracer>> make_embree_tracer(const WorldGeometry& geometry, SurfaceReader surfaces,
                                                   Context& context);

// The alpha rule, shared by all tracers: does a hit of this opacity stop a ray with this key? Deterministic in
// (alpha_key, triangle), and stops the ray with probability `opacity` over random keys.
bool stops_ray(float opacity, std::uint32_t alpha_key, std::uint32_t triangle);

}  // namespace lumel
