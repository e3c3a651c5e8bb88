#include "path/enclosed_points.h"

#include <array>
#include <bit>

#include "base/check.h"
#include "math/frame.h"
#include "math/sampler.h"
#include "math/warp.h"

namespace lumel {

std::uint64_t enclosed_points(std::span<const SurfaceStart> starts, float reach, std::uint32_t key,
                              const Tracer& tracer, const WorldGeometry& geometry, std::span<Ray> rays,
                              std::span<Hit> hits) {
    LUMEL_CHECK(starts.size() <= kSamplesPerTexel && rays.size() >= starts.size() && hits.size() >= starts.size(),
                starts.size(), rays.size(), hits.size());
    std::array<std::uint8_t, kSamplesPerTexel> suspects, far{};
    std::size_t count = starts.size();
    for (std::size_t i = 0; i < count; ++i) suspects[i] = static_cast<std::uint8_t>(i);
    constexpr std::uint32_t kFarAllowed = kEnclosureRays / 4;
    // A ray of each suspect at a time: one that meets anything else clears its point, most of them at once.
    for (std::uint32_t round = 0; round < kEnclosureRays && count > 0; ++round) {
        for (std::size_t i = 0; i < count; ++i) {
            const SurfaceStart& start = starts[suspects[i]];
            const Sampler sampler(key + suspects[i] * 0x9e3779b9u, round);
            rays[i] = {};
            rays[i].origin = start.origin;
            rays[i].direction = Frame(start.normal).to_world(GatherHemisphere::sample(sampler.pair(0)));
            rays[i].skip = start.skip;
            rays[i].alpha_key = sampler.hash(1);
        }
        tracer.closest(rays.first(count), hits.first(count));
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (hits[i].missed() || !hits[i].back_face) continue;
            if ((geometry.triangles[hits[i].triangle].flags & kDoubleSided) == 0) continue;
            if (hits[i].t > reach && ++far[suspects[i]] > kFarAllowed) continue;
            suspects[kept++] = suspects[i];
        }
        count = kept;
    }
    std::uint64_t enclosed = 0;
    for (std::size_t i = 0; i < count; ++i) enclosed |= std::uint64_t{1} << suspects[i];
    return enclosed;
}

std::size_t keep_starts(std::span<SurfaceStart> starts, std::uint64_t kept) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < starts.size(); ++i)
        if ((kept >> i & 1u) != 0) starts[count++] = starts[i];
    return count;
}

std::size_t keep_open_points(std::span<SurfaceStart> starts, std::uint64_t enclosed) {
    const std::size_t kept = static_cast<std::size_t>(std::popcount(enclosed));
    return kept == starts.size() ? kept : keep_starts(starts, ~enclosed);
}

}  // namespace lumel
