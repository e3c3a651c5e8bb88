// The texels of a page, on all threads.
#include <array>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/try.h"
#include "path/path_integrator.h"

namespace lumel {

void RadianceSums::reserve(std::size_t texels) {
    layers.reserve(texels);
    variance.reserve(texels);
    half_difference.reserve(texels);
    sky_visibility.reserve(texels);
    ambient_occlusion.reserve(texels);
    bent_normal.reserve(texels);
    count.reserve(texels);
    traced.reserve(texels);
}

void RadianceSums::resize(std::size_t texels) {
    layers.resize(texels);
    variance.resize(texels);
    half_difference.resize(texels);
    sky_visibility.resize(texels);
    ambient_occlusion.resize(texels);
    bent_normal.resize(texels);
    count.resize(texels);
    traced.resize(texels);
}

Result<RadianceSums> gather_page(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                                 const Transport& transport, const PathOptions& options, std::size_t first,
                                 std::size_t count, Context& context, std::size_t room) {
    LUMEL_CHECK(first + count <= texels.size(), first, count, texels.size());
    RadianceSums sums;
    sums.reserve(room);
    sums.resize(texels.size());
    const PathIntegrator integrator(transport, options);
    std::vector<PathIntegrator::WorkspacePtr> workspaces(context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();

    // Small enough that a cancelled bake stops within a fraction of a second.
    constexpr std::size_t kTexelsPerChunk = 16;
    const std::uint64_t rays_before = transport.tracer.statistics().rays;
    const bool done = parallel_for(
        context, count, kTexelsPerChunk,
        [&](const ChunkRange& range) {
            std::array<SamplePoint, kSamplesPerTexel> points;
            for (std::size_t i = first + range.begin; i < first + range.end; ++i) {
                const std::uint32_t n =
                    sample_points(texels, i, transport.scene, transport.geometry, charts, atlas, points);
                const std::uint64_t id =
                    (std::uint64_t{texels.page} << 32) | (std::uint64_t{texels.y[i]} << 16) | texels.x[i];
                integrator.gather_texel({std::span(points).first(n), id, texels.world_size[i]},
                                        *workspaces[range.worker], sums, i, context);
            }
        },
        "trace", [&] { return transport.tracer.statistics().rays - rays_before; });
    if (!done || context.cancelled()) return cancelled_error();
    return sums;
}

}  // namespace lumel
