// Images of 8 or 16 bits per channel as floats and as textures.
#include <cstring>

#include "base/check.h"
#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

Result<CodedImage> decode_coded(std::span<const std::byte> bytes, std::uint32_t max_edge, const std::string& where) {
    switch (image_format(bytes)) {
        case ImageFormat::png: return decode_png(bytes, max_edge, where);
        case ImageFormat::jpeg: return decode_jpeg(bytes, max_edge, where);
        default: return Error{ErrorCode::unsupported, "is neither PNG nor JPEG", where, "convert it to PNG or JPEG"};
    }
}

std::size_t value_count(const CodedImage& image) { return std::size_t{image.width} * image.height * image.channels; }

std::uint32_t code_at(const CodedImage& image, std::size_t i) {
    if (image.bits == 8) return image.codes[i];
    std::uint16_t code = 0;
    std::memcpy(&code, &image.codes[2 * i], 2);
    return code;
}

// To 8 bits, the nearest: 65535 is 257 times 255.
std::uint8_t eight_bit_code(const CodedImage& image, std::size_t i) {
    const std::uint32_t code = code_at(image, i);
    return static_cast<std::uint8_t>(image.bits == 8 ? code : (code + 128) / 257);
}

}  // namespace

Result<Image> decode_coded_image(std::span<const std::byte> bytes, const std::string& where) {
    LUMEL_TRY(const CodedImage coded, decode_coded(bytes, kMaxImageEdge, where));
    const float largest = coded.bits == 8 ? 255.0f : 65535.0f;
    Image image(coded.width, coded.height, coded.channels);
    LUMEL_CHECK(image.data.size() == value_count(coded), image.data.size());
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(code_at(coded, i)) / largest;
    return image;
}

Result<Texture> decode_texture(std::span<const std::byte> bytes, const std::string& where, bool srgb) {
    LUMEL_TRY(const CodedImage coded, decode_coded(bytes, kMaxTextureEdge, where));
    Texture texture;
    texture.name = where;
    texture.width = coded.width;
    texture.height = coded.height;
    texture.srgb = srgb;
    texture.rgba.reserve(std::size_t{coded.width} * coded.height * 4);
    const bool has_colour = coded.channels >= 3, has_alpha = coded.channels % 2 == 0;
    const std::size_t count = value_count(coded);
    for (std::size_t i = 0; i < count; i += coded.channels) {
        for (std::size_t c = 0; c < 3; ++c) texture.rgba.push_back(eight_bit_code(coded, has_colour ? i + c : i));
        texture.rgba.push_back(has_alpha ? eight_bit_code(coded, i + coded.channels - 1) : std::uint8_t{255});
    }
    return texture;
}

}  // namespace lumel
