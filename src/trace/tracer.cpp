#include "trace/tracer.h"

#include <cmath>

#include "base/hash.h"
#include "math/sampler.h"

namespace lumel {

bool is_traceable(const Ray& ray) {
    // Far inside the range where squared distances stay finite; a comparison with NaN is false.
    constexpr float kLargestCoordinate = 1e18f;
    const bool origin = std::fabs(ray.origin.x) <= kLargestCoordinate &&
                        std::fabs(ray.origin.y) <= kLargestCoordinate && std::fabs(ray.origin.z) <= kLargestCoordinate;
    const float squared_length = dot(ray.direction, ray.direction);
    const bool direction = squared_length > 0.999f && squared_length < 1.001f;
    return origin && direction && ray.tmin >= 0.0f && ray.tmin < ray.tmax && std::isfinite(ray.tmax);
}

bool stops_ray(float opacity, std::uint32_t alpha_key, std::uint32_t triangle) {
    if (opacity >= 1.0f) return true;
    const std::uint64_t bits = mix64((std::uint64_t{triangle} << 32 | alpha_key) + 0x9e3779b97f4a7c15ull);
    return unit_float(static_cast<std::uint32_t>(bits >> 32)) < opacity;
}

}  // namespace lumel
