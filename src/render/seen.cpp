#include "render/seen.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "math/sampler.h"
#include "render/camera_rays.h"

namespace lumel {

Result<SeenSurfaces> see_surfaces(const Tracer& tracer, const WorldGeometry& geometry, const Camera& camera,
                                  std::uint32_t width, std::uint32_t height, bool through_backs, Context& context) {
    const std::size_t pixels = std::size_t{width} * height;
    SeenSurfaces out{width, height, std::vector<Hit>(pixels), std::vector<float>(pixels)};
    const Lens lens(camera, width, height);
    const bool done = parallel_for(context, height, 1, [&](const ChunkRange& range) {
        const auto y = static_cast<std::uint32_t>(range.begin);
        std::vector<Ray> rays(width);
        for (std::uint32_t x = 0; x < width; ++x) {
            rays[x] = lens.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            rays[x].alpha_key = mix32(y * width + x);  // half transparent: a grain of pixels
        }
        const auto hits = std::span(out.hits).subspan(std::size_t{y} * width, width);
        tracer.closest(rays, hits);
        for (std::uint32_t x = 0; x < width; ++x) {
            if (through_backs) pass_culled(tracer, geometry, rays[x], hits[x]);
            if (hits[x].missed()) continue;
            const float cosine = dot(geometry.geometric_normal(hits[x].triangle), rays[x].direction);
            out.facing[std::size_t{y} * width + x] = std::min(std::fabs(cosine), 1.0f);
        }
    });
    if (!done) return cancelled_error();
    return out;
}

}  // namespace lumel
