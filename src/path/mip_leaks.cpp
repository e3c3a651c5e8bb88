#include "path/mip_leaks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "math/constants.h"
#include "math/frame.h"

namespace lumel {
namespace {

// Above the surface by a thousandth of a texel: below what tells a texel's sides apart, above the rounding of places.
Vec3 origin_of(const TexelBuffer& texels, std::size_t i) {
    constexpr float kOfTexel = 1e-3f, kOfPlace = 1e-6f;
    const Vec3 p = texels.position[i];
    const float lift = std::max(kOfTexel * texels.world_size[i], kOfPlace * max_component(max(p, -p)));
    return p + texels.normal[i] * lift;
}

}  // namespace

Result<std::vector<std::uint8_t>> find_mip_leaks(const TexelBuffer& texels, const Transport& transport,
                                                 std::uint32_t mip, Context& context) {
    constexpr std::size_t kTexels = 64;  // of a batch of rays
    std::array<Vec2, kMipLeakRays> around;
    for (std::uint32_t k = 0; k < kMipLeakRays; ++k) {
        const double angle = 2.0 * kPi * k / kMipLeakRays;
        around[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
    std::vector<std::uint8_t> out(texels.size());
    const bool done = parallel_for(context, texels.size(), kTexels, [&](const ChunkRange& range) {
        std::array<Ray, kTexels * kMipLeakRays> rays;
        std::array<Hit, kTexels * kMipLeakRays> hits;
        std::size_t count = 0;
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Frame frame(texels.normal[i]);
            for (const Vec2 direction : around) {
                Ray& ray = rays[count++];
                ray.origin = origin_of(texels, i);
                ray.direction = frame.to_world({direction.x, direction.y, 0.0f});
                ray.tmax = 0.5f * texels.world_size[i] * static_cast<float>(1u << mip);
                ray.alpha_key = static_cast<std::uint32_t>(i);
            }
        }
        transport.tracer.closest(std::span(rays).first(count), std::span(hits).first(count));
        for (std::size_t k = 0; k < count; ++k)
            if (!hits[k].missed() && hits[k].back_face &&
                (transport.geometry.triangles[hits[k].triangle].flags & kDoubleSided) == 0)
                out[range.begin + k / kMipLeakRays] = 1;
    });
    if (!done) return cancelled_error();
    return out;
}

}  // namespace lumel
