#include "path/texel_starts.h"

#include <array>
#include <span>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "math/sampler.h"
#include "path/page_footprints.h"
#include "texel/ray_offset.h"

namespace lumel {
namespace {

// Of points whose starts surface_starts() has found.
float flat_share(const WorldGeometry& geometry, std::span<const SamplePoint> points,
                 std::span<const SurfaceStart> starts) {
    std::size_t flat = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto [triangle, b1, b2] = points[k];
        if (!(geometry.triangles[triangle].flags & kCurved)) continue;
        if (smooth_position(geometry, triangle, b1, b2, false) == geometry.position(triangle, b1, b2)) continue;
        const Vec3 on_facet = offset_origin(geometry, triangle, b1, b2, geometry.geometric_normal(triangle));
        flat += starts[k].origin == on_facet ? 1 : 0;
    }
    return static_cast<float>(flat) / static_cast<float>(points.size());
}

}  // namespace

Result<TexelStarts> find_texel_starts(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                                      const Transport& transport, const PathOptions& options, Context& context) {
    constexpr std::size_t kGrain = 64;
    TexelStarts out;
    out.place.resize(texels.size());
    out.flat_share.resize(texels.size());
    const PathIntegrator integrator(transport, options);
    const PageFootprints footprints(texels, transport, charts, atlas);
    std::vector<PathIntegrator::WorkspacePtr> workspaces(context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();
    const bool done = parallel_for(
        context, texels.size(), kGrain,
        [&](const ChunkRange& range) {
            std::array<SamplePoint, kSamplesPerTexel> points;
            std::array<SurfaceStart, kSamplesPerTexel> starts;
            constexpr std::array<std::uint8_t, kSamplesPerTexel> kFront{};
            PathIntegrator::Workspace& workspace = *workspaces[range.worker];
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const GatherSite site = footprints.site(static_cast<std::uint32_t>(i), points);
                const std::size_t n = site.points.size();
                integrator.surface_starts(site.points, std::span(kFront).first(n), workspace, starts);
                out.flat_share[i] = flat_share(transport.geometry, site.points, std::span(starts).first(n));
                // Texels that look out of both sides of their surface take all of their points.
                const bool both_sides =
                    options.two_sided && (transport.geometry.triangles[points[0].triangle].flags & kDoubleSided) != 0;
                if (both_sides) continue;
                const std::uint32_t key = sampler_key(options.seed, site.id);
                out.place[i] = integrator.choose_starts(site, key, workspace, starts).place;
            }
        },
        "starts");
    if (!done) return cancelled_error();
    return out;
}

}  // namespace lumel
