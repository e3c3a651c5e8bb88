#include "path/gather_page.h"

#include <array>
#include <numeric>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/try.h"
#include "path/page_footprints.h"

namespace lumel {

namespace {

static_assert(kBlockEdge * kBlockEdge == kMostTexelsTogether);

// Where the texels of a block gather.
class BlockSites {
public:
    void read(std::span<const std::uint32_t> block, const PageFootprints& footprints) {
        LUMEL_CHECK(block.size() <= points_.size(), block.size());
        sites_.clear();
        for (std::size_t k = 0; k < block.size(); ++k) sites_.push_back(footprints.site(block[k], points_[k]));
    }
    [[nodiscard]] std::span<const GatherSite> sites() const { return sites_; }

private:
    std::array<std::array<SamplePoint, kSamplesPerTexel>, kMostTexelsTogether> points_;
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
    const PageFootprints footprints(texels, transport, charts, atlas);
    std::vector<BlockSites> sites(context.threads());
    const std::uint64_t rays_before = transport.tracer.statistics().rays;
    const bool done = parallel_for(
        context, blocks.size(), 1,
        [&](const ChunkRange& range) {
            const auto block = blocks.block(range.begin);
            sites[range.worker].read(block, footprints);
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
