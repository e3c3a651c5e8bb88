// Images as blocks of 4 x 4 texels, and back. Texels beyond the image's edge have weight 0.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "image/image.h"
#include "lumel/context.h"
#include "lumel/result.h"

namespace lumel {

constexpr std::uint32_t blocks_across(std::uint32_t texels) { return (texels + 3) / 4; }

constexpr std::size_t block_count(std::uint32_t width, std::uint32_t height) {
    return std::size_t{blocks_across(width)} * blocks_across(height);
}

// The 16 texels of a block by channel. Texels that do not count hold 0.
template <unsigned kChannels>
struct BlockTexels {
    alignas(64) std::array<std::array<float, 16>, kChannels> value;
    alignas(64) std::array<float, 16> weight;
};

// Values 0..1 as codes 0..255, not rounded; beyond: clamped, NaN is 0.
inline std::array<float, 16> to_codes(const std::array<float, 16>& values) {
    std::array<float, 16> out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const float positive = values[i] > 0.0f ? values[i] : 0.0f;
        out[i] = (positive < 1.0f ? positive : 1.0f) * 255.0f;
    }
    return out;
}

// Weights beyond these are taken as 0 and as the largest: encoders divide by their sum.
inline constexpr float kLeastWeight = 1e-30f, kLargestWeight = 1e30f;

// Channels that the image lacks are 0.
template <unsigned kChannels>
void load_block(const Image& image, std::span<const float> weights, std::uint32_t block_x, std::uint32_t block_y,
                BlockTexels<kChannels>& out) {
    const unsigned channels = std::min(kChannels, image.channels);
    for (auto& channel : out.value) channel.fill(0.0f);
    out.weight.fill(0.0f);
    const std::uint32_t rows = std::min(4u, image.height - 4 * block_y),
                        columns = std::min(4u, image.width - 4 * block_x);
    for (std::uint32_t y = 0; y < rows; ++y) {
        const std::size_t first = (std::size_t{4} * block_y + y) * image.width + std::size_t{4} * block_x;
        const float* texel = &image.data[first * image.channels];
        for (std::uint32_t x = 0; x < columns; ++x, texel += image.channels) {
            const float weight = weights.empty() ? 1.0f : weights[first + x];
            if (!(weight > kLeastWeight)) continue;
            out.weight[4 * y + x] = std::min(weight, kLargestWeight);
            for (unsigned c = 0; c < channels; ++c) out.value[c][4 * y + x] = texel[c];
        }
    }
}

// Calls encode(block_x, block_y, bytes) for all blocks, rows of blocks side by side on the context's threads.
template <std::size_t kBytes, class Encode>
Result<std::vector<std::uint8_t>> encode_blocks(const Image& image, std::span<const float> weights, Context& context,
                                                Encode&& encode) {
    LUMEL_CHECK(weights.empty() || weights.size() == std::size_t{image.width} * image.height, weights.size());
    const std::uint32_t columns = blocks_across(image.width);
    std::vector<std::uint8_t> out(block_count(image.width, image.height) * kBytes);
    const bool done = parallel_for(context, blocks_across(image.height), 1, [&](const ChunkRange& rows) {
        const auto y = static_cast<std::uint32_t>(rows.begin);
        for (std::uint32_t x = 0; x < columns; ++x) {
            const std::array<std::uint8_t, kBytes> block = encode(x, y);
            std::memcpy(&out[(std::size_t{y} * columns + x) * kBytes], block.data(), kBytes);
        }
    });
    if (!done) return Error{ErrorCode::cancelled, "cancelled while textures were compressed", "", ""};
    return out;
}

// decode(block, texels) fills 16 x channels floats.
template <std::size_t kBytes, class Decode>
Image decode_blocks(std::span<const std::uint8_t> blocks, std::uint32_t width, std::uint32_t height,
                    std::uint32_t channels, Decode&& decode) {
    LUMEL_CHECK(blocks.size() == block_count(width, height) * kBytes, blocks.size(), width, height);
    LUMEL_CHECK(channels <= 4, channels);
    Image image(width, height, channels);
    const std::uint32_t columns = blocks_across(width);
    std::array<std::uint8_t, kBytes> block;
    std::array<float, 64> texels{};
    for (std::size_t b = 0; b * kBytes < blocks.size(); ++b) {
        std::memcpy(block.data(), &blocks[b * kBytes], kBytes);
        decode(block, texels.data());
        const auto x0 = static_cast<std::uint32_t>(4 * (b % columns)),
                   y0 = static_cast<std::uint32_t>(4 * (b / columns));
        for (std::uint32_t i = 0; i < 16; ++i)
            if (x0 + i % 4 < width && y0 + i / 4 < height)
                std::memcpy(image.at(x0 + i % 4, y0 + i / 4), &texels[std::size_t{i} * channels],
                            channels * sizeof(float));
    }
    return image;
}

}  // namespace lumel
