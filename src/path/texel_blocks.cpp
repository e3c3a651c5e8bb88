#include "path/texel_blocks.h"

#include <algorithm>
#include <tuple>

namespace lumel {

TexelBlocks make_texel_blocks(const TexelBuffer& texels, std::size_t begin, std::size_t end) {
    TexelBlocks out;
    out.first.push_back(0);
    const auto add_band = [&](std::size_t from, std::size_t to) {
        // Of the texels of eight rows: those of one block and chart, in their order.
        std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> band;
        band.reserve(to - from);
        for (std::size_t i = from; i < to; ++i)
            band.emplace_back(texels.x[i] / kBlockEdge, texels.chart[i], static_cast<std::uint32_t>(i));
        std::ranges::sort(band);
        for (std::size_t k = 0; k < band.size();) {
            const auto [column, chart, texel] = band[k];
            const std::size_t start = out.texels.size();
            bool asked_for = false;
            for (; k < band.size() && std::get<0>(band[k]) == column && std::get<1>(band[k]) == chart; ++k) {
                out.texels.push_back(std::get<2>(band[k]));
                asked_for = asked_for || (out.texels.back() >= begin && out.texels.back() < end);
            }
            if (asked_for)
                out.first.push_back(static_cast<std::uint32_t>(out.texels.size()));
            else
                out.texels.resize(start);
        }
    };
    for (std::size_t from = 0, to = 0; from < texels.size(); from = to) {
        const std::uint32_t row = texels.y[from] / kBlockEdge;
        while (to < texels.size() && texels.y[to] / kBlockEdge == row) ++to;
        if (to > begin && from < end) add_band(from, to);
    }
    return out;
}

TexelBlocks spread_blocks(const TexelBlocks& blocks, std::size_t texels) {
    const std::size_t stride = std::max<std::size_t>(1, blocks.texels.size() / std::max<std::size_t>(1, texels));
    TexelBlocks out;
    out.first.push_back(0);
    for (std::size_t b = std::min(stride / 2, blocks.size() - std::min<std::size_t>(1, blocks.size()));
         b < blocks.size(); b += stride) {
        const auto block = blocks.block(b);
        out.texels.insert(out.texels.end(), block.begin(), block.end());
        out.first.push_back(static_cast<std::uint32_t>(out.texels.size()));
    }
    return out;
}

}  // namespace lumel
