#include "io/block_sample.h"

#include <algorithm>

#include "io/encoded_page.h"
#include "lumel/scene.h"

namespace lumel {
namespace {

constexpr std::uint32_t kBlocksAcross = 64;

bool is_baked(const MasterPage& master, std::uint32_t texel) { return texel != kNone && master.coverage[texel] == 3; }

struct Corner {
    std::uint32_t x, y;
};
// Of the blocks with baked texels, and how many of these there are.
struct Places {
    std::vector<Corner> blocks;
    std::size_t baked = 0;
};
Places find_blocks(const MasterPage& master) {
    Places out;
    for (std::uint32_t y = 0; y < master.height; y += 4)
        for (std::uint32_t x = 0; x < master.width; x += 4) {
            std::size_t count = 0;
            for (std::uint32_t v = y; v < std::min(y + 4, master.height); ++v)
                for (std::uint32_t u = x; u < std::min(x + 4, master.width); ++u)
                    count += is_baked(master, master.texel_at[std::size_t{v} * master.width + u]) ? 1 : 0;
            if (count > 0) out.blocks.push_back({x, y});
            out.baked += count;
        }
    return out;
}

}  // namespace

BlockSampler::BlockSampler(std::size_t texels, std::size_t pages)
    : per_page_(std::max<std::size_t>(texels / std::max<std::size_t>(pages, 1), 1)) {}

void BlockSampler::add(const MasterPage& master) {
    const Places places = find_blocks(master);
    if (places.baked == 0) return;
    // As many blocks as hold the wanted texels on average.
    const std::size_t all = places.blocks.size();
    const std::size_t count = std::min(all, (per_page_ * all + places.baked - 1) / places.baked);
    for (std::size_t k = 0; k < count; ++k) {
        const Corner corner = places.blocks[k * all / count];
        add_block(master, corner.x, corner.y);
    }
}

void BlockSampler::add_block(const MasterPage& master, std::uint32_t x0, std::uint32_t y0) {
    Block block{};
    for (std::uint32_t i = 0; i < 16; ++i) {
        const std::uint32_t x = x0 + i % 4, y = y0 + i / 4;
        if (x >= master.width || y >= master.height) continue;
        const std::uint32_t texel = master.texel_at[std::size_t{y} * master.width + x];
        if (texel == kNone) continue;
        block[i] = {static_cast<std::uint32_t>(sample_.light.size()), true, is_baked(master, texel),
                    master.normal[texel]};
        sample_.light.push_back(light_of_texel(master, texel));
        sample_.frame.push_back(tangent_frame(master.normal[texel]));
    }
    blocks_.push_back(block);
}

BlockSample BlockSampler::finish() && {
    constexpr float kOnePlane = 0.99999f;
    EncodedPage& page = sample_.page;
    page.width = 4 * kBlocksAcross;
    page.height = static_cast<std::uint32_t>(4 * ((blocks_.size() + kBlocksAcross - 1) / kBlocksAcross));
    page.texel_at.assign(std::size_t{page.width} * page.height, kNone);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        std::array<std::uint32_t, 16> measured{};
        for (std::uint32_t i = 0; i < 16; ++i) {
            const Cell& cell = blocks_[b][i];
            if (!cell.covered) continue;
            page.texel_at[(4 * (b / kBlocksAcross) + i / 4) * page.width + 4 * (b % kBlocksAcross) + i % 4] =
                cell.light;
            if (!cell.baked) continue;
            measured[i] = static_cast<std::uint32_t>(sample_.baked.size());
            sample_.baked.push_back(cell.light);
            sample_.texels.light.push_back(sample_.light[cell.light]);
            sample_.texels.frame.push_back(sample_.frame[cell.light]);
            const Cell* left = i % 4 > 0 ? &blocks_[b][i - 1] : nullptr;
            if (left && left->baked && dot(left->normal, cell.normal) >= kOnePlane)
                sample_.texels.neighbours.push_back({measured[i - 1], measured[i]});
        }
    }
    return std::move(sample_);
}

}  // namespace lumel
