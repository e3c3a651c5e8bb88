// BC1: RGB as two 5:6:5 end points and two bits a texel, 8 bytes for 4 x 4 texels.
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

struct Bc1Options {
    BcQuality quality = BcQuality::normal;
};

// Values 0..1 (beyond: clamped; NaN: 0) of RGB, always opaque: no texel that counts uses the transparent code. Weights
// as in bc/bc6h.h; a block of none is black.
Result<std::vector<std::uint8_t>> encode_bc1(const Image& image, std::span<const float> weights,
                                             const Bc1Options& options, Context& context);

// R, G, B, A of 16 texels in 0..1, in the real numbers of the specification; decoders in hardware may round to eight
// bits.
std::array<float, 64> decode_bc1_block(const BcBlock8& block);

Image decode_bc1(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height);

}  // namespace lumel
