// The texels of a page in blocks that lie together on one surface: what their paths are guided by is shared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "texel/texel_buffer.h"

namespace lumel {

inline constexpr std::uint32_t kBlockEdge = 8;  // texels; a block lies on the page's grid of such squares

struct TexelBlocks {
    std::vector<std::uint32_t> texels;  // block after block, in each in the page's order
    std::vector<std::uint32_t> first;   // per block into `texels`, plus one past the end

    [[nodiscard]] std::size_t size() const { return first.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> block(std::size_t b) const {
        return std::span(texels).subspan(first[b], first[b + 1] - first[b]);
    }
};

// The blocks that hold any of the texels [begin, end): whole, for what a texel gathers must not depend on the range.
TexelBlocks make_texel_blocks(const TexelBuffer& texels, std::size_t begin, std::size_t end);

// Of blocks, every so many-th, so that they hold about that many texels; at least one, where there is one.
TexelBlocks spread_blocks(const TexelBlocks& blocks, std::size_t texels);

}  // namespace lumel
