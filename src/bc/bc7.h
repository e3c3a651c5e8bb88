// BC7: RGB or RGBA in eight bits, 16 bytes for 4 x 4 texels.
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

struct Bc7Options {
    BcQuality quality = BcQuality::normal;
    bool only_mode_6 = false;  // one subset of four channels: what the benchmark compares with
};

// Values 0..1 (beyond: clamped; NaN: 0) of up to four channels; an image without the fourth is opaque. Weights as in
// bc/bc6h.h: of the squared error, 0 for texels that may come out as anything; a block of none is black.
Result<std::vector<std::uint8_t>> encode_bc7(const Image& image, std::span<const float> weights,
                                             const Bc7Options& options, Context& context);

// Codes 0..255, R, G, B, A of 16 texels. Exact. The reserved mode is black and transparent.
std::array<std::uint8_t, 64> decode_bc7_block(const BcBlock16& block);

// Values are codes / 255, four channels.
Image decode_bc7(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height);

}  // namespace lumel
