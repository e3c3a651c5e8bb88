// The decoders behind read_image, one file each. All take foreign bytes: every size is checked before it is allocated,
// truncation is an error, and no image may be larger than the file could have described.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "io/image_io.h"
#include "lumel/result.h"

namespace lumel {

inline constexpr std::uint32_t kMaxImageEdge = 16384;
inline constexpr std::uint32_t kMaxTextureEdge = 8192;

// What the first bytes say the file is.
enum class ImageFormat : std::uint8_t { unknown, png, jpeg, hdr, exr, pfm, pgm };
ImageFormat image_format(std::span<const std::byte> bytes);

// Width and height positive and at most max_edge; values (pixels times channels) not beyond 64 M plus 128 for each byte
// of the file, or where it is `deflated` up to 400 M at 4128 for each: a hostile header asks for far more.
Status check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t channels, std::uint32_t max_edge,
                        std::size_t file_bytes, const std::string& where, bool deflated = false);

// An image of 8 or 16 bits as its file stores it, not linearised: rows from the top; 1 channel is grey, 2 are grey and
// alpha, 3 RGB, 4 RGBA. Codes of 16 bits are in this machine's byte order.
struct CodedImage {
    std::uint32_t width = 0, height = 0, channels = 1, bits = 8;
    std::vector<std::uint8_t> codes;  // width * height * channels * bits / 8 bytes
};
Result<CodedImage> decode_png(std::span<const std::byte> bytes, std::uint32_t max_edge, const std::string& where);
Result<CodedImage> decode_jpeg(std::span<const std::byte> bytes, std::uint32_t max_edge, const std::string& where);

// PNG or JPEG, codes divided by the largest.
Result<Image> decode_coded_image(std::span<const std::byte> bytes, const std::string& where);
Result<Image> decode_hdr(std::span<const std::byte> bytes, const std::string& where);
Result<Image> decode_pfm(std::span<const std::byte> bytes, const std::string& where);
Result<Image> decode_pgm(std::span<const std::byte> bytes, const std::string& where);
Result<Image> decode_exr(std::span<const std::byte> bytes, const std::string& where);
Result<std::vector<std::string>> decode_exr_channel_names(std::span<const std::byte> bytes, const std::string& where);
// Empty `names` means all.
Result<NamedChannels> decode_exr_channels(std::span<const std::byte> bytes, std::span<const std::string> names,
                                          const std::string& where);
// The same up to `rows` rows at a time: files too large to hold as floats.
Status decode_exr_bands(std::span<const std::byte> bytes, std::span<const std::string> names, std::uint32_t rows,
                        const ExrBand& band, const std::string& where);

}  // namespace lumel
