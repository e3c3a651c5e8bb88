// BC6H: RGB in half floats, 16 bytes for 4 x 4 texels, unsigned or signed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bc/block_bits.h"
#include "bc/quality.h"
#include "image/image.h"
#include "lumel/context.h"
#include "lumel/result.h"

namespace lumel {

struct Bc6hOptions {
    BcQuality quality = BcQuality::normal;
    bool is_signed = false;     // unsigned clamps negative values to 0
    bool only_mode_11 = false;  // one region of ten bits: what the benchmark compares with
};

// RGB (further channels are left out) into blocks, row by row. `weights` has a number >= 0 for each texel, or is empty
// for ones: how much the squared error of its half-float codes counts, which for values above 6e-5 is the relative
// error. Texels of weight 0 cost nothing and may come out as anything; a block of none is black. NaN counts as 0, what
// exceeds half floats as the largest one. The same bytes for any number of threads, on every machine.
Result<std::vector<std::uint8_t>> encode_bc6h(const Image& image, std::span<const float> weights,
                                              const Bc6hOptions& options, Context& context);

// Half-float bits, R, G, B of 16 texels. Exact: what every conforming decoder gives. Reserved modes are black.
std::array<std::uint16_t, 48> decode_bc6h_block(const BcBlock16& block, bool is_signed);

// Precondition: blocks.size() is that of an image of this size.
Image decode_bc6h(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height, bool is_signed);

}  // namespace lumel
