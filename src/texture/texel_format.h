// What texels are stored as: the formats of GPUs that files of ours use, and the codes that put light into the bytes of
// a PNG or a .hdr. One table: bytes, numbers of the graphics interfaces, encoder and decoder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bc/quality.h"
#include "image/image.h"
#include "lumel/context.h"
#include "lumel/result.h"

namespace lumel {

enum class TexelFormat : std::uint8_t {
    rgba16f,
    rgb9e5,
    rgba8,
    bc1,
    bc4,
    bc5,
    bc6h_unsigned,
    bc6h_signed,
    bc7,
    // What shaders decode themselves (light_codes.h); files are PNG or .hdr.
    rgbm,
    rgbd,
    logluv,
    rgbe,
};

struct TexelFormatInfo {
    const char* name;                       // Vulkan's without VK_FORMAT_, or that of the code
    std::uint32_t vk_format, dxgi_format;   // 0: no GPU knows it
    std::uint32_t block_edge, block_bytes;  // texels along a block, 1 or 4
    std::uint32_t channels;                 // that are stored; an image may have fewer
    // Light goes up to here, and must be scaled to fit: 0 where any does.
    float largest;
};
const TexelFormatInfo& format_info(TexelFormat format);

constexpr double bytes_per_texel(const TexelFormatInfo& info) {
    return static_cast<double>(info.block_bytes) / (info.block_edge * info.block_edge);
}
// Of an image: blocks that its edges cut are whole.
std::size_t texel_bytes(TexelFormat format, std::uint32_t width, std::uint32_t height);

// Row 0 first. Channels that the image lacks are 0, alpha is 1. Light where the format holds light, else 0..1. Weights
// as in bc/bc6h.h: formats without blocks write texels of weight 0 as they are. Error: cancelled.
Result<std::vector<std::uint8_t>> encode_texels(TexelFormat format, const Image& image, std::span<const float> weights,
                                                BcQuality quality, Context& context);
// What a GPU, or the shader, reads: 1 to 4 channels. Precondition: as many bytes as texel_bytes says.
Image decode_texels(TexelFormat format, std::span<const std::uint8_t> bytes, std::uint32_t width, std::uint32_t height);

}  // namespace lumel
