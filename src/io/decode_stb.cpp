// PNG and JPEG through stb_image: the one file that holds it. stb reports errors but trusts sizes, so those are checked
// here before it allocates.
#include <limits>
#include <memory>

#include "base/try.h"
#include "io/image_codecs.h"
#include "io/jpeg_fence.h"
#include "io/png_fence.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 16384
// An empty IDAT chunk makes stb copy zero bytes to a null pointer: harmless, but not to the sanitizer.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((no_sanitize("nonnull-attribute"))), apply_to = function)
#endif
#include <stb_image.h>
#if defined(__clang__)
#pragma clang attribute pop
#endif

namespace lumel {
namespace {

struct StbFree {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};
template <class T>
using StbPixels = std::unique_ptr<T[], StbFree>;

struct StbHeader {
    int width = 0, height = 0, channels = 0;
};

const stbi_uc* data(std::span<const std::byte> bytes) { return reinterpret_cast<const stbi_uc*>(bytes.data()); }

Error undecodable(const std::string& where) {
    const char* reason = stbi_failure_reason();
    return {ErrorCode::invalid_input, std::string("cannot be decoded: ") + (reason ? reason : "unknown reason"), where,
            "the image is damaged or of an unusual kind; save it again as plain PNG or JPEG"};
}

Result<StbHeader> read_header(std::span<const std::byte> bytes, std::uint32_t max_edge, const std::string& where) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        return Error{ErrorCode::unsupported, "is larger than 2 GB", where, "make the image smaller"};
    const ImageFormat format = image_format(bytes);
    if (format != ImageFormat::png && format != ImageFormat::jpeg)
        return Error{ErrorCode::unsupported, "is neither PNG nor JPEG", where, "convert it to PNG or JPEG"};
    if (format == ImageFormat::jpeg) LUMEL_TRY_STATUS(check_jpeg_tables(bytes, where));
    if (format == ImageFormat::png) LUMEL_TRY_STATUS(check_png_chunks(bytes, where));
    StbHeader header;
    if (stbi_info_from_memory(data(bytes), static_cast<int>(bytes.size()), &header.width, &header.height,
                              &header.channels) == 0)
        return undecodable(where);
    LUMEL_TRY_STATUS(check_image_size(static_cast<std::uint64_t>(header.width),
                                      static_cast<std::uint64_t>(header.height), 4, max_edge, bytes.size(), where));
    return header;
}

template <class T>
Image to_image(const T* pixels, const StbHeader& header) {
    Image image(static_cast<std::uint32_t>(header.width), static_cast<std::uint32_t>(header.height),
                static_cast<std::uint32_t>(header.channels));
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = static_cast<float>(pixels[i]) / static_cast<float>(std::numeric_limits<T>::max());
    return image;
}

}  // namespace

Result<Image> decode_stb(std::span<const std::byte> bytes, const std::string& where) {
    LUMEL_TRY(StbHeader header, read_header(bytes, kMaxImageEdge, where));
    const auto size = static_cast<int>(bytes.size());
    if (stbi_is_16_bit_from_memory(data(bytes), size) != 0) {
        const StbPixels<stbi_us> pixels(
            stbi_load_16_from_memory(data(bytes), size, &header.width, &header.height, &header.channels, 0));
        if (!pixels) return undecodable(where);
        return to_image(pixels.get(), header);
    }
    const StbPixels<stbi_uc> pixels(
        stbi_load_from_memory(data(bytes), size, &header.width, &header.height, &header.channels, 0));
    if (!pixels) return undecodable(where);
    return to_image(pixels.get(), header);
}

Result<Texture> decode_texture(std::span<const std::byte> bytes, const std::string& where, bool srgb) {
    LUMEL_TRY(StbHeader header, read_header(bytes, kMaxTextureEdge, where));
    const StbPixels<stbi_uc> pixels(stbi_load_from_memory(data(bytes), static_cast<int>(bytes.size()), &header.width,
                                                          &header.height, &header.channels, 4));
    if (!pixels) return undecodable(where);
    Texture texture;
    texture.name = where;
    texture.width = static_cast<std::uint32_t>(header.width);
    texture.height = static_cast<std::uint32_t>(header.height);
    texture.srgb = srgb;
    texture.rgba.assign(pixels.get(), pixels.get() + std::size_t{texture.width} * texture.height * 4);
    return texture;
}

}  // namespace lumel
