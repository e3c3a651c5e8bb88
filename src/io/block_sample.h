// Blocks of 4 x 4 texels that stand for all pages of a bake: what encodings and their storage are measured on.
#pragma once

#include <cstdint>
#include <vector>

#include "encode/encoded_page.h"
#include "encode/reconstruction_error.h"
#include "io/master.h"

namespace lumel {

// The blocks side by side, as one page; around baked texels it has those that were filled or dilated, as pages do.
struct BlockSample {
    EncodedPage page;               // without numbers
    std::vector<TexelLight> light;  // of its covered texels, each in its tangent frame
    std::vector<Rotation> frame;
    std::vector<std::uint32_t> baked;  // those of them that count
    MeasuredTexels texels;             // these, with pairs of neighbours in one block and plane
};

// Takes of each page its share of the blocks that have baked texels, evenly spread.
class BlockSampler {
public:
    // Of all pages together about so many baked texels.
    BlockSampler(std::size_t texels, std::size_t pages);
    void add(const MasterPage& master);
    [[nodiscard]] BlockSample finish() &&;

private:
    struct Cell {  // a texel of a block
        std::uint32_t light = 0;
        bool covered = false, baked = false;
        Vec3 normal{};
    };
    using Block = std::array<Cell, 16>;
    void add_block(const MasterPage& master, std::uint32_t x0, std::uint32_t y0);

    std::size_t per_page_;
    BlockSample sample_;
    std::vector<Block> blocks_;
};

}  // namespace lumel
