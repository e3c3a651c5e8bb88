// The reference decoder of BC7: plain, exact, for any 16 bytes.
// Based on: Khronos Data Format Specification 1.3, section "BC7".
#include <bit>
#include <utility>

#include "bc/bc7.h"
#include "bc/bc7_modes.h"
#include "bc/block_image.h"
#include "bc/partitions.h"

namespace lumel {
namespace {

struct EndPoints {
    std::array<std::array<std::uint32_t, 4>, 6> value{};  // two for each subset
};

// `bits` bits widened to eight by repeating the top ones.
std::uint32_t widened(std::uint32_t value, unsigned bits) {
    value <<= 8 - bits;
    return value | value >> bits;
}

EndPoints read_end_points(BlockReader& reader, const Bc7Mode& mode) {
    EndPoints ends;
    const unsigned count = 2u * mode.subsets;
    for (unsigned c = 0; c < 4; ++c)
        for (unsigned e = 0; e < count; ++e) ends.value[e][c] = reader.read(c < 3 ? mode.colour_bits : mode.alpha_bits);
    const unsigned low = mode.low_bit == Bc7LowBit::none ? 0 : 1;
    std::uint32_t bit = 0;
    for (unsigned e = 0; e < count; ++e) {
        if (mode.low_bit == Bc7LowBit::each || (mode.low_bit == Bc7LowBit::shared && e % 2 == 0)) bit = reader.read(1);
        for (unsigned c = 0; c < 3; ++c)
            ends.value[e][c] = widened(ends.value[e][c] << low | bit, mode.colour_bits + low);
        ends.value[e][3] = mode.alpha_bits == 0 ? 255 : widened(ends.value[e][3] << low | bit, mode.alpha_bits + low);
    }
    return ends;
}

std::array<unsigned, 16> read_indices(BlockReader& reader, unsigned subsets, unsigned partition, unsigned bits) {
    std::array<unsigned, 16> out{};
    for (unsigned i = 0; i < 16 && bits > 0; ++i)
        out[i] = reader.read(bits - (is_anchor(subsets, partition, i) ? 1 : 0));
    return out;
}

std::uint8_t between(std::uint32_t a, std::uint32_t b, unsigned index, unsigned bits) {
    const auto weight = static_cast<std::uint32_t>(palette_weight(index, bits));
    return static_cast<std::uint8_t>((a * (64 - weight) + b * weight + 32) >> 6);
}

}  // namespace

std::array<std::uint8_t, 64> decode_bc7_block(const BcBlock16& block) {
    std::array<std::uint8_t, 64> out{};
    const auto number = static_cast<unsigned>(std::countr_zero(block[0]));
    if (number >= kBc7ModeTable.size()) return out;
    const Bc7Mode& mode = kBc7ModeTable[number];
    BlockReader reader(block);
    reader.read(number + 1);
    const unsigned partition = reader.read(mode.partition_bits), rotation = reader.read(mode.rotation_bits);
    const bool swapped = reader.read(mode.selector_bits) != 0;
    const EndPoints ends = read_end_points(reader, mode);
    const auto first = read_indices(reader, mode.subsets, partition, mode.index_bits);
    const auto second = read_indices(reader, mode.subsets, partition, mode.second_index_bits);
    // Alpha follows the colour, or has indices of its own; the selector gives these to the colour.
    const auto *colour = &first, *alpha = mode.second_index_bits == 0 ? &first : &second;
    unsigned colour_bits = mode.index_bits;
    unsigned alpha_bits = mode.second_index_bits == 0 ? mode.index_bits : mode.second_index_bits;
    if (swapped) {
        std::swap(colour, alpha);
        std::swap(colour_bits, alpha_bits);
    }
    for (unsigned i = 0; i < 16; ++i) {
        const unsigned e = 2 * subset_of(mode.subsets, partition, i);
        for (unsigned c = 0; c < 4; ++c)
            out[4 * i + c] = between(ends.value[e][c], ends.value[e + 1][c], c < 3 ? (*colour)[i] : (*alpha)[i],
                                     c < 3 ? colour_bits : alpha_bits);
        if (rotation > 0) std::swap(out[4 * i + rotation - 1], out[4 * i + 3]);
    }
    return out;
}

Image decode_bc7(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height) {
    return decode_blocks<16>(blocks, width, height, 4, [](const BcBlock16& block, float* texels) {
        for (const std::uint8_t code : decode_bc7_block(block)) *texels++ = static_cast<float>(code) / 255.0f;
    });
}

}  // namespace lumel
