#include "texel/texel_surface.h"

#include <array>

#include "base/cancelled.h"
#include "base/parallel.h"

namespace lumel {

Result<TexelSurface> read_texel_surface(const TexelBuffer& texels, const Scene& scene, const WorldGeometry& geometry,
                                        const ChartSet& charts, const Atlas& atlas, Context& context) {
    TexelSurface out;
    out.albedo.resize(texels.size());
    out.emission.resize(texels.size());
    const SurfaceReader surfaces(scene, geometry);
    const bool done = parallel_for(context, texels.size(), 1024, [&](const ChunkRange& range) {
        std::array<SamplePoint, kSamplesPerTexel> points;
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const std::uint32_t n = sample_points(texels, i, scene, geometry, charts, atlas, points);
            Vec3 albedo{}, emission{};
            for (std::uint32_t k = 0; k < n; ++k) {
                const auto& [triangle, b1, b2] = points[k];
                albedo += surfaces.albedo(triangle, b1, b2);
                if (geometry.triangles[triangle].flags & kEmissive) emission += surfaces.emission(triangle, b1, b2);
            }
            out.albedo[i] = albedo * (1.0f / static_cast<float>(n));
            out.emission[i] = emission * (1.0f / static_cast<float>(n));
        }
    });
    if (!done) return cancelled_error();
    return out;
}

}  // namespace lumel
