#include "io/encoded_target.h"

#include <algorithm>
#include <array>

#include "io/page_files.h"

namespace lumel {
namespace {

constexpr std::array kFormats{EncodedFormat{"exr", EncodedFile::exr, ".exr", nullptr},
                              EncodedFormat{"ktx2", EncodedFile::ktx2, ".ktx2", nullptr},
                              EncodedFormat{"dds", EncodedFile::dds, ".dds", nullptr},
                              EncodedFormat{"png-rgbm", EncodedFile::png, ".png", "rgbm"},
                              EncodedFormat{"png-rgbd", EncodedFile::png, ".png", "rgbd"},
                              EncodedFormat{"png-logluv", EncodedFile::png, ".png", "logluv"},
                              EncodedFormat{"hdr", EncodedFile::hdr, ".hdr", "rgbe"}};

std::string stem(const Encoding& encoding, const StoredTexture& texture) {
    std::string name = texture.name;
    std::ranges::replace(name, '.', '-');
    return encoded_stem(encoding.name) + "_" + name;
}

// Radiance files hold light only: beside them are PNG files.
std::string extension_of(const StoredTexture& texture, const EncodedFormat& format) {
    return format.file == EncodedFile::hdr && texture.format != TexelFormat::rgbe ? ".png" : format.extension;
}

}  // namespace

std::span<const EncodedFormat> encoded_formats() { return kFormats; }

const EncodedFormat* find_encoded_format(std::string_view name) {
    const auto* const at = std::ranges::find_if(kFormats, [&](const EncodedFormat& f) { return name == f.name; });
    return at == kFormats.end() ? nullptr : at;
}

std::string encoded_texture_file(const Encoding& encoding, const StoredTexture& texture, const EncodedFormat& format) {
    return stem(encoding, texture) + extension_of(texture, format);
}

std::string encoded_texture_file(const Encoding& encoding, const StoredTexture& texture, const EncodedFormat& format,
                                 std::uint32_t page, std::uint32_t mip) {
    return stem(encoding, texture) + "_" + page_and_mip(page, mip) + extension_of(texture, format);
}

bool is_encoded_texture_file(const Encoding& encoding, const std::string& name) {
    if (!name.starts_with(encoded_stem(encoding.name) + "_")) return false;
    for (const TextureStorage& storage : texture_storages())
        for (const StoredTexture& texture : texture_layout(encoding, storage))
            for (const char* extension : {".ktx2", ".dds", ".png", ".hdr"})
                if (name == stem(encoding, texture) + extension ||
                    is_numbered_with_mip(name, stem(encoding, texture) + "_", extension))
                    return true;
    return false;
}

}  // namespace lumel
