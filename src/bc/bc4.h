// BC4: one channel as two end points of eight bits and three bits a texel, 8 bytes for 4 x 4 texels.
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

struct Bc4Options {
    BcQuality quality = BcQuality::normal;
};

// Values 0..1 (beyond: clamped; NaN: 0) of the first channel. Weights as in bc/bc6h.h; a block of none is 0.
Result<std::vector<std::uint8_t>> encode_bc4(const Image& image, std::span<const float> weights,
                                             const Bc4Options& options, Context& context);

// One block of values 0..255; texels of weight 0 may hold anything finite.
BcBlock8 encode_bc4_block(const std::array<float, 16>& codes, const std::array<float, 16>& weights, BcQuality quality);

// 16 values in 0..1, in the real numbers of the specification.
std::array<float, 16> decode_bc4_block(const BcBlock8& block);

Image decode_bc4(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height);

}  // namespace lumel
