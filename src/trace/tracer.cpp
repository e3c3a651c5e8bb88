#include "trace/tracer.h"

#include "base/hash.h"
#include "math/sampler.h"

namespace lumel {

bool stops_ray(float opacity, std::uint32_t alpha_key, std::uint32_t triangle) {
    if (opacity >= 1.0f) return true;
    const std::uint64_t bits = mix64((std::uint64_t{triangle} << 32 | alpha_key) + 0x9e3779b97f4a7c15ull);
    return unit_float(static_cast<std::uint32_t>(bits >> 32)) < opacity;
}

}  // namespace lumel
