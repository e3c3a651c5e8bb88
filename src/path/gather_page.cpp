#include "path/gather_page.h"

#include <array>
#include <numeric>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/try.h"
#include "path/visible_starts.h"

namespace lumel {

namespace {

static_assert(kBlockEdge * kBlockEdge == kMostTexelsTogether);

// Where the texels of a block gather.
class BlockSites {
public:
    void read(std::span<const std::uint32_t> block, const TexelBuffer& texels, const Transport& transport,
              const ChartSet& charts, const Atlas& atlas) {
        LUMEL_CHECK(block.size() <= points_.size(), block.size());
        sites_.clear();
        for (std::size_t k = 0; k < block.size(); ++k) {
            const std::uint32_t i = block[k];
            const auto points = [&](Points& out, Footprint footprint) {
                return std::span<const SamplePoint>(out).first(sample_points(
                    texels, i, transport.scene, transport.geometry, charts, atlas, out, footprint));
            };
            GatherSite site;
            site.points = points(points_[k], Footprint::gather);
            if (~texels.valid[i] == 0) site.whole = points(whole_[k], Footprint::whole);
            site.id = (std::uint64_t{texels.page} << 32) | (std::uint64_t{texels.y[i]} << 16) | texels.x[i];
            site.texel_size = texels.world_size[i];
            site.valid = texels.valid[i];
            const std::uint32_t first = texels.first_triangle[i], end = texels.first_triangle[i + 1];
            site.triangles = std::span(&texels.triangles[first], end - first);
            const std::uint32_t middle = site.points[nearest_to_centre(site.valid)].triangle;
            site.axes =
                texel_axes(transport.geometry.corners(middle),
                           atlas.triangle_uv(charts, transport.geometry, transport.scene, middle).texels);
            sites_.push_back(site);
        }
    }
    [[nodiscard]] std::span<const GatherSite> sites() const { return sites_; }

private:
    using Points = std::array<SamplePoint, kSamplesPerTexel>;
    std::array<Points, kMostTexelsTogether> points_, whole_;
    std::vector<GatherSite> sites_;
};

// Blocks are gathered whole: what was not asked for stays zero.
void clear_outside(RadianceSums& sums, std::size_t begin, std::size_t end) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (i == begin) i = end;
        if (i < sums.size()) sums.clear(i);
    }
}

// `index_of(b)`: where in the sums the texels of block b go.
template <class IndexOf>
Status gather(const TexelBlocks& blocks, const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
              const Transport& transport, const PathOptions& options, IndexOf&& index_of, RadianceSums& sums,
              Context& context) {
    const PathIntegrator integrator(transport, options);
    std::vector<PathIntegrator::WorkspacePtr> workspaces(context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();
    std::vector<BlockSites> sites(context.threads());
    const std::uint64_t rays_before = transport.tracer.statistics().rays;
    const bool done = parallel_for(
        context, blocks.size(), 1,
        [&](const ChunkRange& range) {
            const auto block = blocks.block(range.begin);
            sites[range.worker].read(block, texels, transport, charts, atlas);
            integrator.gather_texels(sites[range.worker].sites(), index_of(range.begin), *workspaces[range.worker],
                                     sums, context);
        },
        "trace", [&] { return transport.tracer.statistics().rays - rays_before; });
    if (!done || context.cancelled()) return cancelled_error();
    return success();
}

}  // namespace

Result<RadianceSums> gather_blocks(const TexelBlocks& blocks, const TexelBuffer& texels, const ChartSet& charts,
                                   const Atlas& atlas, const Transport& transport, const PathOptions& options,
                                   Context& context) {
    RadianceSums sums;
    sums.resize(blocks.texels.size());
    std::vector<std::uint32_t> places(blocks.texels.size());
    std::iota(places.begin(), places.end(), 0u);
    const auto index_of = [&](std::size_t b) {
        return std::span<const std::uint32_t>(places).subspan(blocks.first[b], blocks.first[b + 1] - blocks.first[b]);
    };
    LUMEL_TRY_STATUS(gather(blocks, texels, charts, atlas, transport, options, index_of, sums, context));
    return sums;
}

Result<RadianceSums> gather_page(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                                 const Transport& transport, const PathOptions& options, std::size_t first,
                                 std::size_t count, Context& context, std::size_t room) {
    LUMEL_CHECK(first + count <= texels.size(), first, count, texels.size());
    const TexelBlocks blocks = make_texel_blocks(texels, first, first + count);
    RadianceSums sums;
    sums.reserve(room);
    sums.resize(texels.size());
    const auto index_of = [&](std::size_t b) { return blocks.block(b); };
    LUMEL_TRY_STATUS(gather(blocks, texels, charts, atlas, transport, options, index_of, sums, context));
    clear_outside(sums, first, first + count);
    return sums;
}

}  // namespace lumel
