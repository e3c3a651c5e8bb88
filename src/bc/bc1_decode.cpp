// The reference decoder of BC1.
// Based on: Khronos Data Format Specification 1.3, section "BC1 with alpha".
#include <algorithm>

#include "bc/bc1.h"
#include "bc/block_image.h"

namespace lumel {
namespace {

using Colour = std::array<float, 4>;

Colour from_565(std::uint32_t code) {
    return {static_cast<float>(code >> 11) / 31.0f, static_cast<float>(code >> 5 & 63) / 63.0f,
            static_cast<float>(code & 31) / 31.0f, 1.0f};
}

// (wa a + wb b) / (wa + wb)
Colour mixed(const Colour& a, const Colour& b, float wa, float wb) {
    Colour out;
    for (std::size_t c = 0; c < 4; ++c) out[c] = (wa * a[c] + wb * b[c]) / (wa + wb);
    return out;
}

}  // namespace

std::array<float, 64> decode_bc1_block(const BcBlock8& block) {
    BlockReader reader(block);
    const std::uint32_t first = reader.read(16), second = reader.read(16);
    const Colour a = from_565(first), b = from_565(second);
    const std::array<Colour, 4> palette = first > second
                                              ? std::array<Colour, 4>{a, b, mixed(a, b, 2, 1), mixed(a, b, 1, 2)}
                                              : std::array<Colour, 4>{a, b, mixed(a, b, 1, 1), Colour{}};
    std::array<float, 64> out;
    for (std::size_t i = 0; i < 16; ++i) std::copy_n(palette[reader.read(2)].begin(), 4, &out[4 * i]);
    return out;
}

Image decode_bc1(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height) {
    return decode_blocks<8>(blocks, width, height, 4, [](const BcBlock8& block, float* texels) {
        const std::array<float, 64> decoded = decode_bc1_block(block);
        std::copy(decoded.begin(), decoded.end(), texels);
    });
}

}  // namespace lumel
