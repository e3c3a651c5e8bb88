// A texture as KTX2 and DDS files hold it: texels of one format in layers and mip levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "texture/texel_format.h"

namespace lumel {

struct TextureArray {
    TexelFormat format = TexelFormat::rgba8;
    std::uint32_t width = 0, height = 0;
    std::uint32_t layers = 1;  // one: files hold a plain texture, not an array
    // The full size first, each half the one before it (rounded down, at least 1): all layers one after the other.
    std::vector<std::vector<std::uint8_t>> levels;
};

// Size of an edge of a level.
constexpr std::uint32_t level_edge(std::uint32_t edge, std::size_t level) {
    const std::uint32_t size = level < 32 ? edge >> level : 0;
    return size > 0 ? size : 1;
}

// Preconditions of both: a format that GPUs know, at least one level, levels of the right size.

// Khronos Texture 2.0, each level compressed by Zstandard at `zstd_level` (1 to 19), or as it is where that is 0.
std::vector<std::byte> encode_ktx2(const TextureArray& texture, int zstd_level);
// Direct Draw Surface with the header of Direct3D 10.
std::vector<std::byte> encode_dds(const TextureArray& texture);

namespace detail {

// Little-endian numbers, one after the other.
class FileBytes {
public:
    void u32(std::uint64_t v) { put(v, 4); }
    void u64(std::uint64_t v) { put(v, 8); }
    void bytes(const void* data, std::size_t size) {
        const auto* from = static_cast<const std::byte*>(data);
        out_.insert(out_.end(), from, from + size);
    }
    void pad_to(std::size_t multiple) { out_.resize((out_.size() + multiple - 1) / multiple * multiple); }
    [[nodiscard]] std::size_t size() const { return out_.size(); }
    [[nodiscard]] std::vector<std::byte> finish() && { return std::move(out_); }

private:
    void put(std::uint64_t v, unsigned count) {
        for (unsigned i = 0; i < count; ++i) out_.push_back(static_cast<std::byte>(v >> (8 * i)));
    }
    std::vector<std::byte> out_;
};

void check_texture(const TextureArray& texture);

}  // namespace detail
}  // namespace lumel
