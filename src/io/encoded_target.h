// What `lumel encode` writes an encoding as: kind of file, textures, effort.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "encode/encoding.h"
#include "texture/layout.h"

namespace lumel {

enum class EncodedFile : std::uint8_t { exr, ktx2, dds, png, hdr };

struct EncodedFormat {
    const char* name;  // of --format
    EncodedFile file;
    const char* extension;  // with its dot
    const char* storage;    // the one that it implies; nullptr: none (EXR), or any that GPUs read
};
std::span<const EncodedFormat> encoded_formats();
// nullptr where there is none of that name.
const EncodedFormat* find_encoded_format(std::string_view name);

struct EncodedTarget {
    const EncodedFormat* format = &encoded_formats()[0];  // EXR
    const TextureStorage* storage = nullptr;              // none for EXR
    BcQuality quality = BcQuality::normal;
    // KTX2 and DDS: how many pages of one size share a file as its layers; 0: each page has files of its own.
    std::uint32_t layers = 0;
};

// "encoded_l1-hhd_L1n-R.ktx2", or with the page, and the mip in a file of its own: "encoded_l1-hhd_L1n-R_0_mip1.png".
std::string encoded_texture_file(const Encoding& encoding, const StoredTexture& texture, const EncodedFormat& format);
std::string encoded_texture_file(const Encoding& encoding, const StoredTexture& texture, const EncodedFormat& format,
                                 std::uint32_t page, std::uint32_t mip = 0);
// Is it the name of such a file, in any format and storage?
bool is_encoded_texture_file(const Encoding& encoding, const std::string& name);

}  // namespace lumel
