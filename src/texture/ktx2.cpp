// KTX2 files. Based on: Khronos, "KTX File Format Specification 2.0" (header, index, levels), and "Khronos Data Format
// Specification 1.3" (the basic data format descriptor). bytesPlane0 is that of the blocks also where Zstandard packs
// them, as KTX-Specification #221 and validators since libktx 4.4 want it.
#include <zstd.h>

#include <array>
#include <numeric>
#include <string_view>

#include "base/check.h"
#include "texture/texture_file.h"

namespace lumel {
namespace {

constexpr std::array<std::uint8_t, 12> kIdentifier{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kLevelIndex = 80;  // header and index before it
constexpr std::uint32_t kZstandard = 2;

// One channel of a texel block.
struct Sample {
    std::uint8_t offset, bits, channel;  // channel: with what says how it is coded
    std::uint32_t lower, upper;          // what stands for 0 (or -1) and 1
};
constexpr std::uint8_t kFloat = 0x80, kSigned = 0x40, kExponent = 0x20, kAlpha = 15;
constexpr std::uint32_t kOne = 0x3F800000u, kMinusOne = 0xBF800000u;  // as floats

struct Description {
    std::uint8_t colour_model;
    std::uint32_t type_size;  // bytes that change places on big-endian machines
    std::vector<Sample> samples;
};

constexpr std::uint8_t kRgbsda = 1, kBc1 = 128, kBc4 = 131, kBc5 = 132, kBc6h = 133, kBc7 = 134;

Description describe(TexelFormat format) {
    const auto halves = [](std::uint8_t offset, std::uint8_t channel) {
        return Sample{offset, 16, static_cast<std::uint8_t>(channel | kFloat | kSigned), kMinusOne, kOne};
    };
    // 8448 is 2^9 (2^5 - 1 - 15 + 0.5): the mantissa that stands for 1 at no exponent at all.
    const auto mantissa = [](std::uint8_t offset, std::uint8_t channel) { return Sample{offset, 9, channel, 0, 8448}; };
    const auto exponent = [](std::uint8_t channel) {
        return Sample{27, 5, static_cast<std::uint8_t>(channel | kExponent), 15, 31};
    };
    switch (format) {
        case TexelFormat::rgba16f:
            return {kRgbsda, 2, {halves(0, 0), halves(16, 1), halves(32, 2), halves(48, kAlpha)}};
        case TexelFormat::rgb9e5:
            return {
                kRgbsda, 4, {mantissa(0, 0), exponent(0), mantissa(9, 1), exponent(1), mantissa(18, 2), exponent(2)}};
        case TexelFormat::rgba8:
            return {kRgbsda, 1, {{0, 8, 0, 0, 255}, {8, 8, 1, 0, 255}, {16, 8, 2, 0, 255}, {24, 8, kAlpha, 0, 255}}};
        case TexelFormat::bc1: return {kBc1, 1, {{0, 64, 0, 0, ~0u}}};
        case TexelFormat::bc4: return {kBc4, 1, {{0, 64, 0, 0, ~0u}}};
        case TexelFormat::bc5: return {kBc5, 1, {{0, 64, 0, 0, ~0u}, {64, 64, 1, 0, ~0u}}};
        case TexelFormat::bc6h_unsigned: return {kBc6h, 1, {{0, 128, kFloat, 0, kOne}}};
        case TexelFormat::bc6h_signed: return {kBc6h, 1, {{0, 128, kFloat | kSigned, kMinusOne, kOne}}};
        case TexelFormat::bc7: return {kBc7, 1, {{0, 128, 0, 0, ~0u}}};
        case TexelFormat::rgbm:
        case TexelFormat::rgbd:
        case TexelFormat::logluv:
        case TexelFormat::rgbe: break;
    }
    LUMEL_CHECK(false, format_info(format).name);
    return {};
}

std::vector<std::byte> format_descriptor(const TexelFormatInfo& format, const Description& description) {
    constexpr std::uint32_t kVersion = 2, kBt709 = 1, kLinear = 1;
    const std::size_t block = 24 + 16 * description.samples.size();
    detail::FileBytes out;
    out.u32(block + 4);
    out.u32(0);  // Khronos; basic format
    out.u32(kVersion | block << 16);
    out.u32(description.colour_model | kBt709 << 8 | kLinear << 16);
    out.u32((format.block_edge - 1) | (format.block_edge - 1) << 8);
    out.u64(format.block_bytes);
    for (const Sample& s : description.samples) {
        out.u32(s.offset | (s.bits - 1u) << 16 | std::uint32_t{s.channel} << 24);
        out.u32(0);  // in the middle of its block
        out.u32(s.lower);
        out.u32(s.upper);
    }
    return std::move(out).finish();
}

// Keys in the order of their bytes.
std::vector<std::byte> key_values() {
    using namespace std::string_view_literals;
    detail::FileBytes out;
    for (const std::string_view pair : {"KTXorientation\0rd\0"sv, "KTXwriter\0lumel\0"sv}) {
        out.u32(pair.size());
        out.bytes(pair.data(), pair.size());
        out.pad_to(4);
    }
    return std::move(out).finish();
}

std::vector<std::uint8_t> compress(const std::vector<std::uint8_t>& bytes, int level) {
    std::vector<std::uint8_t> out(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
    LUMEL_CHECK(ZSTD_isError(size) == 0, ZSTD_getErrorName(size));
    out.resize(size);
    return out;
}

}  // namespace

std::vector<std::byte> encode_ktx2(const TextureArray& texture, int zstd_level) {
    detail::check_texture(texture);
    const TexelFormatInfo& format = format_info(texture.format);
    const Description description = describe(texture.format);
    const std::vector<std::byte> descriptor = format_descriptor(format, description), values = key_values();
    const std::size_t count = texture.levels.size();
    std::vector<std::vector<std::uint8_t>> packed;
    for (const std::vector<std::uint8_t>& level : texture.levels)
        if (zstd_level > 0) packed.push_back(compress(level, zstd_level));
    const auto stored = [&](std::size_t i) -> const std::vector<std::uint8_t>& {
        return zstd_level > 0 ? packed[i] : texture.levels[i];
    };

    // Levels come last, the smallest first; plain ones start at whole blocks.
    const std::size_t alignment = zstd_level > 0 ? 1 : std::lcm(format.block_bytes, 4u);
    const std::size_t descriptor_at = kLevelIndex + 24 * count, values_at = descriptor_at + descriptor.size();
    std::vector<std::size_t> level_at(count);
    std::size_t end = values_at + values.size();
    for (std::size_t i = count; i-- > 0;) {
        level_at[i] = (end + alignment - 1) / alignment * alignment;
        end = level_at[i] + stored(i).size();
    }

    detail::FileBytes out;
    out.bytes(kIdentifier.data(), kIdentifier.size());
    out.u32(format.vk_format);
    out.u32(description.type_size);
    out.u32(texture.width);
    out.u32(texture.height);
    out.u32(0);  // depth
    out.u32(texture.layers > 1 ? texture.layers : 0);
    out.u32(1);  // faces
    out.u32(count);
    out.u32(zstd_level > 0 ? kZstandard : 0);
    out.u32(descriptor_at);
    out.u32(descriptor.size());
    out.u32(values_at);
    out.u32(values.size());
    out.u64(0);  // no data of the supercompression
    out.u64(0);
    for (std::size_t i = 0; i < count; ++i) {
        out.u64(level_at[i]);
        out.u64(stored(i).size());
        out.u64(texture.levels[i].size());
    }
    out.bytes(descriptor.data(), descriptor.size());
    out.bytes(values.data(), values.size());
    for (std::size_t i = count; i-- > 0;) {
        out.pad_to(alignment);
        out.bytes(stored(i).data(), stored(i).size());
    }
    LUMEL_CHECK(out.size() == end, out.size(), end);
    return std::move(out).finish();
}

}  // namespace lumel
