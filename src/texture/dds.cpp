// DDS files. Based on: Microsoft, "Programming Guide for DDS" (DDS_HEADER, DDS_HEADER_DXT10).
#include "texture/texture_file.h"

namespace lumel {
namespace {

constexpr std::uint32_t kHeaderSize = 124, kPixelFormatSize = 32;
// DDSD_CAPS, _HEIGHT, _WIDTH, _PIXELFORMAT: all files; then what some have.
constexpr std::uint32_t kAlways = 0x1007, kPitch = 0x8, kMipMapCount = 0x20000, kLinearSize = 0x80000;
constexpr std::uint32_t kFourCc = 0x4, kDx10 = 0x30315844;  // "DX10"
constexpr std::uint32_t kCapsTexture = 0x1000, kCapsComplex = 0x8, kCapsMipMap = 0x400000;
constexpr std::uint32_t kTexture2d = 3;     // D3D10_RESOURCE_DIMENSION_TEXTURE2D
constexpr std::uint32_t kAlphaUnknown = 0;  // DDS_ALPHA_MODE_UNKNOWN: what is in alpha is no transparency

}  // namespace

std::vector<std::byte> encode_dds(const TextureArray& texture) {
    detail::check_texture(texture);
    const TexelFormatInfo& format = format_info(texture.format);
    const bool blocks = format.block_edge > 1, mips = texture.levels.size() > 1;
    detail::FileBytes out;
    out.bytes("DDS ", 4);
    out.u32(kHeaderSize);
    out.u32(kAlways | (blocks ? kLinearSize : kPitch) | (mips ? kMipMapCount : 0));
    out.u32(texture.height);
    out.u32(texture.width);
    out.u32(blocks ? texel_bytes(texture.format, texture.width, texture.height)
                   : std::size_t{texture.width} * format.block_bytes);
    out.u32(0);  // depth
    out.u32(texture.levels.size());
    for (int i = 0; i < 11; ++i) out.u32(0);
    out.u32(kPixelFormatSize);
    out.u32(kFourCc);
    out.u32(kDx10);
    for (int i = 0; i < 5; ++i) out.u32(0);  // bits and masks
    out.u32(kCapsTexture | (mips ? kCapsMipMap : 0) | (mips || texture.layers > 1 ? kCapsComplex : 0));
    for (int i = 0; i < 4; ++i) out.u32(0);  // further caps

    out.u32(format.dxgi_format);
    out.u32(kTexture2d);
    out.u32(0);  // no cube
    out.u32(texture.layers);
    out.u32(kAlphaUnknown);

    for (std::size_t layer = 0; layer < texture.layers; ++layer)
        for (const std::vector<std::uint8_t>& level : texture.levels) {
            const std::size_t size = level.size() / texture.layers;
            out.bytes(level.data() + layer * size, size);
        }
    return std::move(out).finish();
}

}  // namespace lumel
