// The reference decoder of BC4.
// Based on: Khronos Data Format Specification 1.3, section "BC4 unsigned".
#include <algorithm>

#include "bc/bc4.h"
#include "bc/block_image.h"

namespace lumel {

std::array<float, 16> decode_bc4_block(const BcBlock8& block) {
    BlockReader reader(block);
    const auto a = static_cast<float>(reader.read(8)), b = static_cast<float>(reader.read(8));
    std::array<float, 8> palette = {a, b, 0, 0, 0, 0, 0, 255.0f};
    const std::size_t steps = a > b ? 7 : 5;
    for (std::size_t k = 1; k < steps; ++k)
        palette[k + 1] = (static_cast<float>(steps - k) * a + static_cast<float>(k) * b) / static_cast<float>(steps);
    std::array<float, 16> out;
    for (float& value : out) value = palette[reader.read(3)] / 255.0f;
    return out;
}

Image decode_bc4(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height) {
    return decode_blocks<8>(blocks, width, height, 1, [](const BcBlock8& block, float* texels) {
        const std::array<float, 16> decoded = decode_bc4_block(block);
        std::copy(decoded.begin(), decoded.end(), texels);
    });
}

}  // namespace lumel
