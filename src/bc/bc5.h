// BC5: two channels, each as BC4, 16 bytes for 4 x 4 texels.
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

struct Bc5Options {
    BcQuality quality = BcQuality::normal;
};

// As encode_bc4, of the first two channels.
Result<std::vector<std::uint8_t>> encode_bc5(const Image& image, std::span<const float> weights,
                                             const Bc5Options& options, Context& context);

// Two channels of 16 texels.
std::array<float, 32> decode_bc5_block(const BcBlock16& block);

Image decode_bc5(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height);

}  // namespace lumel
