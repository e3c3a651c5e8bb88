// The reference decoder of BC5: two of BC4.
#include <algorithm>

#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/block_image.h"

namespace lumel {

std::array<float, 32> decode_bc5_block(const BcBlock16& block) {
    std::array<float, 32> out;
    for (std::size_t c = 0; c < 2; ++c) {
        BcBlock8 half;
        std::copy_n(&block[8 * c], 8, half.begin());
        const std::array<float, 16> values = decode_bc4_block(half);
        for (std::size_t i = 0; i < 16; ++i) out[2 * i + c] = values[i];
    }
    return out;
}

Image decode_bc5(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height) {
    return decode_blocks<16>(blocks, width, height, 2, [](const BcBlock16& block, float* texels) {
        const std::array<float, 32> decoded = decode_bc5_block(block);
        std::copy(decoded.begin(), decoded.end(), texels);
    });
}

}  // namespace lumel
