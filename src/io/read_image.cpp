// Which decoder reads an image, and the sky, the one image with rules of its own.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

constexpr std::uint64_t kMaxImageFile = std::uint64_t{8} << 30;

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

// Grey becomes three equal channels; alpha is dropped.
Vec3 pixel(const Image& image, std::size_t index) {
    const float* p = &image.data[index * image.channels];
    return image.channels < 3 ? Vec3{p[0], p[0], p[0]} : Vec3{p[0], p[1], p[2]};
}

Status check_radiance(Vec3 radiance, std::size_t x, std::size_t y, const std::string& where) {
    const bool sane = is_finite(radiance) && std::min({radiance.x, radiance.y, radiance.z}) >= 0.0f;
    if (sane) return success();
    return Error{ErrorCode::invalid_input,
                 "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is negative or not finite", where,
                 "repair the map: radiance is at least zero"};
}

}  // namespace

ImageFormat image_format(std::span<const std::byte> bytes) {
    using namespace std::string_view_literals;
    if (starts_with(bytes, "\x89PNG\r\n\x1a\n"sv)) return ImageFormat::png;
    if (starts_with(bytes, "\xff\xd8\xff"sv)) return ImageFormat::jpeg;
    if (starts_with(bytes, "#?RADIANCE"sv) || starts_with(bytes, "#?RGBE"sv)) return ImageFormat::hdr;
    if (starts_with(bytes, "\x76\x2f\x31\x01"sv)) return ImageFormat::exr;
    if (starts_with(bytes, "PF\n"sv) || starts_with(bytes, "Pf\n"sv) || starts_with(bytes, "PF "sv) ||
        starts_with(bytes, "Pf "sv))
        return ImageFormat::pfm;
    if (starts_with(bytes, "P5"sv) || starts_with(bytes, "P6"sv)) return ImageFormat::pgm;
    return ImageFormat::unknown;
}

Status check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t channels, std::uint32_t max_edge,
                        std::size_t file_bytes, const std::string& where, bool deflated) {
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width == 0 || height == 0) return Error{ErrorCode::invalid_input, "has no pixels", where, "save it again"};
    if (width > max_edge || height > max_edge)
        return Error{
            ErrorCode::unsupported,
            "has " + size + "; at most " + std::to_string(max_edge) + " x " + std::to_string(max_edge) + " are read",
            where, "make it smaller"};
    // Deflate makes of a single colour 1032 times less; grey counts as four channels.
    const std::uint64_t honest =
        deflated ? std::min<std::uint64_t>(4 * 1032 * std::uint64_t{file_bytes}, 400000000) : 0;
    if (width * height * channels > std::max(honest, (std::uint64_t{64} << 20) + 128 * std::uint64_t{file_bytes}))
        return Error{
            ErrorCode::unsupported,
            "says it has " + size + ", more than are read from a file of " + std::to_string(file_bytes) + " bytes",
            where, "make the image smaller, or save it again if the file is damaged"};
    return success();
}

Result<Image> decode_image(std::span<const std::byte> bytes, const std::string& where) {
    switch (image_format(bytes)) {
        case ImageFormat::png:
        case ImageFormat::jpeg: return decode_coded_image(bytes, where);
        case ImageFormat::hdr: return decode_hdr(bytes, where);
        case ImageFormat::exr: return decode_exr(bytes, where);
        case ImageFormat::pfm: return decode_pfm(bytes, where);
        case ImageFormat::pgm: return decode_pgm(bytes, where);
        case ImageFormat::unknown: break;
    }
    return Error{ErrorCode::unsupported, "is no image that Lumel knows", where,
                 "give PNG, JPEG, Radiance HDR, OpenEXR, PFM, PGM or PPM"};
}

Result<Image> read_image(const std::filesystem::path& path) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxImageFile));
    return decode_image(bytes, path.string());
}

Result<bool> is_eight_bit_image(const std::filesystem::path& path) {
    std::array<char, 16> head{};
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), head.size());
    if (in.bad() || in.gcount() == 0) return Error{ErrorCode::io, "cannot be read", path.string(), "check the path"};
    const ImageFormat format = image_format(std::as_bytes(std::span(head)));
    return format == ImageFormat::png || format == ImageFormat::jpeg || format == ImageFormat::pgm;
}

Result<NamedChannels> read_exr_channels(const std::filesystem::path& path, std::span<const std::string> names) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxImageFile));
    return decode_exr_channels(bytes, names, path.string());
}

Result<std::vector<std::string>> read_exr_channel_names(const std::filesystem::path& path) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxImageFile));
    return decode_exr_channel_names(bytes, path.string());
}

Result<SkyMap> read_sky(const std::filesystem::path& path) {
    const std::string where = path.string();
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxImageFile));
    const ImageFormat format = image_format(bytes);
    if (format != ImageFormat::hdr && format != ImageFormat::exr)
        return Error{ErrorCode::unsupported, "is no Radiance HDR or OpenEXR file", where,
                     "give an equirectangular .hdr or .exr map"};
    LUMEL_TRY(const Image image, decode_image(bytes, where));
    if (image.width != 2 * image.height)
        return Error{ErrorCode::invalid_input,
                     "is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                         " pixels, not twice as wide as high",
                     where, "give an equirectangular map"};
    SkyMap map{image.width, image.height, {}};
    map.radiance.reserve(std::size_t{image.width} * image.height);
    for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i) {
        const Vec3 radiance = pixel(image, i);
        LUMEL_TRY_STATUS(check_radiance(radiance, i % image.width, i / image.width, where));
        map.radiance.push_back(radiance);
    }
    return map;
}

}  // namespace lumel
