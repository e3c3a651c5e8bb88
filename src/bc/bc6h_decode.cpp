// The reference decoder of BC6H: plain, exact, for any 16 bytes.
// Based on: Khronos Data Format Specification 1.3, section "BC6H".
#include <algorithm>

#include "bc/bc6h.h"
#include "bc/bc6h_modes.h"
#include "bc/block_image.h"
#include "bc/partitions.h"
#include "math/half.h"

namespace lumel {
namespace {

using EndPoints = std::array<std::array<std::int32_t, 3>, 4>;

const Bc6hMode* mode_of(BlockReader& reader) {
    std::uint32_t code = reader.read(2);
    const unsigned bits = code < 2 ? 2 : 5;
    if (bits == 5) code |= reader.read(3) << 2;
    const auto found = std::find_if(kBc6hModeTable.begin(), kBc6hModeTable.end(),
                                    [&](const Bc6hMode& mode) { return mode.code_bits == bits && mode.code == code; });
    return found == kBc6hModeTable.end() ? nullptr : &*found;
}

std::uint32_t reversed_bits(std::uint32_t value, unsigned count) {
    std::uint32_t out = 0;
    for (unsigned i = 0; i < count; ++i) out |= ((value >> i) & 1u) << (count - 1 - i);
    return out;
}

EndPoints read_end_points(BlockReader& reader, const Bc6hMode& mode) {
    EndPoints ends{};
    for (unsigned f = 0; f < mode.field_count; ++f) {
        const Bc6hField& field = mode.fields[f];
        const std::uint32_t bits = reader.read(field.count);
        const std::uint32_t value = field.reversed ? reversed_bits(bits, field.count) : bits;
        ends[field.end][field.channel] |= static_cast<std::int32_t>(value << field.low);
    }
    return ends;
}

std::int32_t sign_extended(std::int32_t value, unsigned bits) {
    const std::int32_t sign = 1 << (bits - 1);
    return ((value & ((1 << bits) - 1)) ^ sign) - sign;
}

// Differences become numbers of the mode's full width.
void undo_transform(EndPoints& ends, const Bc6hMode& mode, bool is_signed) {
    for (unsigned c = 0; c < 3; ++c) {
        if (is_signed) ends[0][c] = sign_extended(ends[0][c], mode.end_bits);
        for (unsigned e = 1; e < 4; ++e) {
            if (mode.transformed) {
                const std::int32_t sum = ends[0][c] + sign_extended(ends[e][c], mode.other_bits[c]);
                ends[e][c] = sum & ((1 << mode.end_bits) - 1);
            }
            if (is_signed) ends[e][c] = sign_extended(ends[e][c], mode.end_bits);
        }
    }
}

std::int32_t unquantized(std::int32_t q, unsigned bits, bool is_signed) {
    if (!is_signed) {
        if (bits >= 15 || q == 0) return q;
        return q == (1 << bits) - 1 ? 0xFFFF : ((q << 16) + 0x8000) >> bits;
    }
    if (bits >= 16 || q == 0) return q;
    const std::int32_t size = q < 0 ? -q : q;
    const std::int32_t value = size >= (1 << (bits - 1)) - 1 ? 0x7FFF : ((size << 15) + 0x4000) >> (bits - 1);
    return q < 0 ? -value : value;
}

std::uint16_t finished(std::int32_t value, bool is_signed) {
    if (!is_signed) return static_cast<std::uint16_t>((value * 31) >> 6);
    const std::int32_t size = ((value < 0 ? -value : value) * 31) >> 5;
    return static_cast<std::uint16_t>(value < 0 ? size | 0x8000 : size);
}

}  // namespace

std::array<std::uint16_t, 48> decode_bc6h_block(const BcBlock16& block, bool is_signed) {
    std::array<std::uint16_t, 48> out{};
    BlockReader reader(block);
    const Bc6hMode* mode = mode_of(reader);
    if (mode == nullptr) return out;
    EndPoints ends = read_end_points(reader, *mode);
    undo_transform(ends, *mode, is_signed);
    const unsigned partition = mode->regions == 2 ? reader.read(5) : 0;
    for (unsigned i = 0; i < 16; ++i) {
        const unsigned anchor = is_anchor(mode->regions, partition, i) ? 1 : 0;
        const int weight = palette_weight(reader.read(mode->index_bits() - anchor), mode->index_bits());
        const unsigned first = 2 * subset_of(mode->regions, partition, i);
        for (unsigned c = 0; c < 3; ++c) {
            const std::int32_t a = unquantized(ends[first][c], mode->end_bits, is_signed);
            const std::int32_t b = unquantized(ends[first + 1][c], mode->end_bits, is_signed);
            out[3 * i + c] = finished((a * (64 - weight) + b * weight + 32) >> 6, is_signed);
        }
    }
    return out;
}

Image decode_bc6h(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height, bool is_signed) {
    return decode_blocks<16>(blocks, width, height, 3, [is_signed](const BcBlock16& block, float* texels) {
        const std::array<std::uint16_t, 48> codes = decode_bc6h_block(block, is_signed);
        std::transform(codes.begin(), codes.end(), texels, half_to_float);
    });
}

}  // namespace lumel
