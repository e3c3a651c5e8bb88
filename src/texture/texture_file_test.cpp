// Headers byte by byte, with the numbers of the specifications worked out by hand.
#include "texture/texture_file.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>

namespace lumel {
namespace {

std::uint32_t u32(const std::vector<std::byte>& file, std::size_t at) {
    std::uint32_t out = 0;
    std::memcpy(&out, &file.at(at + 3) - 3, 4);
    return out;
}
std::uint64_t u64(const std::vector<std::byte>& file, std::size_t at) {
    return u32(file, at) | std::uint64_t{u32(file, at + 4)} << 32;
}

std::vector<std::uint32_t> words(const std::vector<std::byte>& file, std::size_t at, std::size_t count) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(u32(file, at + 4 * i));
    return out;
}
using Words = std::vector<std::uint32_t>;

// Bytes 0, 1, 2 .. on.
TextureArray counting(TexelFormat format, std::uint32_t width, std::uint32_t height, std::uint32_t layers,
                      std::size_t levels) {
    TextureArray out{format, width, height, layers, {}};
    std::uint8_t next = 0;
    for (std::size_t i = 0; i < levels; ++i) {
        out.levels.emplace_back(layers * texel_bytes(format, level_edge(width, i), level_edge(height, i)));
        for (std::uint8_t& byte : out.levels.back()) byte = next++;
    }
    return out;
}

bool holds(const std::vector<std::byte>& file, std::size_t at, const std::vector<std::uint8_t>& bytes) {
    return at + bytes.size() <= file.size() && std::memcmp(&file[at], bytes.data(), bytes.size()) == 0;
}

TEST(Ktx2, HeaderOfOneBc6hImage) {
    const TextureArray texture = counting(TexelFormat::bc6h_unsigned, 8, 4, 1, 1);
    const std::vector<std::byte> file = encode_ktx2(texture, 0);
    EXPECT_EQ(words(file, 0, 3), (Words{0x58544BABu, 0xBB303220u, 0x0A1A0A0Du}));
    // vkFormat, typeSize, width, height, depth, layers, faces, levels, scheme.
    EXPECT_EQ(words(file, 12, 9), (Words{143, 1, 8, 4, 0, 0, 1, 1, 0}));
    // Descriptor after 80 bytes and one level of 24: 4 + 24 + one sample of 16; then two pairs, each with its length.
    EXPECT_EQ(words(file, 48, 4), (Words{104, 44, 148, 44}));
    EXPECT_EQ(u64(file, 64), 0u);
    EXPECT_EQ(u64(file, 72), 0u);
    EXPECT_EQ(u64(file, 80), 192u) << "148 + 44, a multiple of the block";
    EXPECT_EQ(u64(file, 88), 32u);
    EXPECT_EQ(u64(file, 96), 32u);
    // Total; vendor and type; version 2, size 40; model 133, BT.709, linear; 4 x 4; 16 bytes.
    EXPECT_EQ(words(file, 104, 7), (Words{44, 0, 2 | 40 << 16, 133 | 1 << 8 | 1 << 16, 0x0303, 16, 0}));
    // 128 bits from 0, float; position; 0 .. 1.0f.
    EXPECT_EQ(words(file, 132, 4), (Words{127u << 16 | 0x80u << 24, 0, 0, 0x3F800000u}));
    EXPECT_EQ(u32(file, 148), 18u);
    EXPECT_EQ(std::memcmp(&file[152], "KTXorientation\0rd\0\0\0", 20), 0);
    EXPECT_EQ(u32(file, 172), 16u);
    EXPECT_EQ(std::memcmp(&file[176], "KTXwriter\0lumel", 16), 0);
    EXPECT_TRUE(holds(file, 192, texture.levels[0]));
    EXPECT_EQ(file.size(), 192u + 32u);
}

TEST(Ktx2, DescriptorsOfTheOtherFormats) {
    const auto samples = [](TexelFormat format, std::size_t count) {
        const std::vector<std::byte> file = encode_ktx2(counting(format, 4, 4, 1, 1), 0);
        EXPECT_EQ(u32(file, 104), 4 + 24 + 16 * count);
        Words out = words(file, 116, 1);  // model and its company
        for (std::size_t i = 0; i < count; ++i)
            for (const std::size_t word : {0u, 2u, 3u}) out.push_back(u32(file, 132 + 16 * i + 4 * word));
        return out;
    };
    constexpr std::uint32_t kLinear709 = 1 << 8 | 1 << 16, kAll = 0xFFFFFFFFu;
    EXPECT_EQ(samples(TexelFormat::bc6h_signed, 1),
              (Words{133 | kLinear709, 127u << 16 | 0xC0u << 24, 0xBF800000u, 0x3F800000u}));
    EXPECT_EQ(samples(TexelFormat::bc7, 1), (Words{134 | kLinear709, 127u << 16, 0, kAll}));
    EXPECT_EQ(samples(TexelFormat::bc1, 1), (Words{128 | kLinear709, 63u << 16, 0, kAll}));
    EXPECT_EQ(samples(TexelFormat::bc4, 1), (Words{131 | kLinear709, 63u << 16, 0, kAll}));
    EXPECT_EQ(samples(TexelFormat::bc5, 2),
              (Words{132 | kLinear709, 63u << 16, 0, kAll, 64 | 63u << 16 | 1u << 24, 0, kAll}));
    EXPECT_EQ(samples(TexelFormat::rgba8, 4),
              (Words{1 | kLinear709, 7u << 16, 0, 255, 8 | 7u << 16 | 1u << 24, 0, 255, 16 | 7u << 16 | 2u << 24, 0,
                     255, 24 | 7u << 16 | 15u << 24, 0, 255}));
    constexpr std::uint32_t kMinus = 0xBF800000u, kOne = 0x3F800000u;
    EXPECT_EQ(samples(TexelFormat::rgba16f, 4),
              (Words{1 | kLinear709, 15u << 16 | 0xC0u << 24, kMinus, kOne, 16 | 15u << 16 | 0xC1u << 24, kMinus, kOne,
                     32 | 15u << 16 | 0xC2u << 24, kMinus, kOne, 48 | 15u << 16 | 0xCFu << 24, kMinus, kOne}));
    // Nine bits a channel, each with the five bits of the exponent at 27.
    EXPECT_EQ(samples(TexelFormat::rgb9e5, 6),
              (Words{1 | kLinear709, 8u << 16, 0, 8448, 27 | 4u << 16 | 0x20u << 24, 15, 31, 9 | 8u << 16 | 1u << 24, 0,
                     8448, 27 | 4u << 16 | 0x21u << 24, 15, 31, 18 | 8u << 16 | 2u << 24, 0, 8448,
                     27 | 4u << 16 | 0x22u << 24, 15, 31}));
}

TEST(Ktx2, TypeSizeIsThatOfWhatChangesPlaces) {
    const auto format_and_type = [](TexelFormat format) {
        return words(encode_ktx2(counting(format, 4, 4, 1, 1), 0), 12, 2);
    };
    EXPECT_EQ(format_and_type(TexelFormat::rgba16f), (Words{97, 2}));
    EXPECT_EQ(format_and_type(TexelFormat::rgb9e5), (Words{123, 4}));
    EXPECT_EQ(format_and_type(TexelFormat::rgba8), (Words{37, 1}));
    EXPECT_EQ(format_and_type(TexelFormat::bc1), (Words{131, 1}));
    EXPECT_EQ(format_and_type(TexelFormat::bc4), (Words{139, 1}));
    EXPECT_EQ(format_and_type(TexelFormat::bc5), (Words{141, 1}));
    EXPECT_EQ(format_and_type(TexelFormat::bc6h_signed), (Words{144, 1}));
    EXPECT_EQ(format_and_type(TexelFormat::bc7), (Words{145, 1}));
}

TEST(Ktx2, LayersAndLevelsSmallestFirst) {
    const TextureArray texture = counting(TexelFormat::bc4, 9, 6, 3, 4);
    const std::vector<std::byte> file = encode_ktx2(texture, 0);
    EXPECT_EQ(words(file, 20, 6), (Words{9, 6, 0, 3, 1, 4}));
    // 3 x 2, 1 x 1, 1 x 1, 1 x 1 blocks of 8 bytes in three layers.
    std::size_t last = file.size();
    const std::size_t sizes[] = {144, 24, 24, 24};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = u64(file, 80 + 24 * i);
        EXPECT_EQ(u64(file, 88 + 24 * i), sizes[i]);
        EXPECT_EQ(at % 8, 0u);
        EXPECT_EQ(at + sizes[i], last) << i;
        EXPECT_TRUE(holds(file, at, texture.levels[i]));
        last = at;
    }
}

TEST(Ktx2, LevelsAreFramesOfZstandard) {
    const TextureArray texture = counting(TexelFormat::bc7, 64, 64, 2, 2);
    const std::vector<std::byte> file = encode_ktx2(texture, 9);
    EXPECT_EQ(u32(file, 44), 2u);
    EXPECT_EQ(u32(file, 104 + 24 + 20), 16u) << "bytesPlane0 stays that of the blocks";
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t at = u64(file, 80 + 24 * i), size = u64(file, 88 + 24 * i);
        ASSERT_EQ(u64(file, 96 + 24 * i), texture.levels[i].size());
        std::vector<std::uint8_t> back(texture.levels[i].size());
        EXPECT_EQ(ZSTD_decompress(back.data(), back.size(), &file.at(at), size), back.size());
        EXPECT_EQ(back, texture.levels[i]);
    }
    EXPECT_EQ(file, encode_ktx2(texture, 9));
}

TEST(Dds, HeaderOfAnArrayWithLevels) {
    const TextureArray texture = counting(TexelFormat::bc7, 8, 8, 2, 2);
    const std::vector<std::byte> file = encode_dds(texture);
    EXPECT_EQ(std::memcmp(file.data(), "DDS ", 4), 0);
    // Size; caps, height, width, format, mip count, linear size; height, width; bytes of the first level; depth;
    // levels.
    EXPECT_EQ(words(file, 4, 7), (Words{124, 0x1007 | 0x20000 | 0x80000, 8, 8, 64, 0, 2}));
    EXPECT_EQ(words(file, 76, 3), (Words{32, 4, 0x30315844}));
    EXPECT_EQ(u32(file, 108), 0x1000u | 0x8u | 0x400000u);
    // BC7_UNORM, 2-D, no cube, two layers, alpha of no meaning.
    EXPECT_EQ(words(file, 128, 5), (Words{98, 3, 0, 2, 0}));
    // Layer by layer, large levels first: 64 and 16 bytes.
    ASSERT_EQ(file.size(), 148u + 2 * (64 + 16));
    const auto part = [&](std::size_t level, std::size_t from, std::size_t count) {
        const auto& bytes = texture.levels[level];
        return std::vector<std::uint8_t>(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(from + count));
    };
    EXPECT_TRUE(holds(file, 148, part(0, 0, 64)));
    EXPECT_TRUE(holds(file, 148 + 64, part(1, 0, 16)));
    EXPECT_TRUE(holds(file, 148 + 80, part(0, 64, 64)));
    EXPECT_TRUE(holds(file, 148 + 144, part(1, 16, 16)));
}

TEST(Dds, PlainTexelsHaveAPitch) {
    const std::vector<std::byte> file = encode_dds(counting(TexelFormat::rgba16f, 5, 3, 1, 1));
    EXPECT_EQ(words(file, 4, 7), (Words{124, 0x1007 | 0x8, 3, 5, 40, 0, 1}));
    EXPECT_EQ(u32(file, 108), 0x1000u);
    EXPECT_EQ(words(file, 128, 5), (Words{10, 3, 0, 1, 0}));
    EXPECT_EQ(file.size(), 148u + 5 * 3 * 8);
    const auto dxgi = [](TexelFormat format) { return u32(encode_dds(counting(format, 4, 4, 1, 1)), 128); };
    EXPECT_EQ(dxgi(TexelFormat::rgb9e5), 67u);
    EXPECT_EQ(dxgi(TexelFormat::rgba8), 28u);
    EXPECT_EQ(dxgi(TexelFormat::bc1), 71u);
    EXPECT_EQ(dxgi(TexelFormat::bc4), 80u);
    EXPECT_EQ(dxgi(TexelFormat::bc5), 83u);
    EXPECT_EQ(dxgi(TexelFormat::bc6h_unsigned), 95u);
    EXPECT_EQ(dxgi(TexelFormat::bc6h_signed), 96u);
}

}  // namespace
}  // namespace lumel
