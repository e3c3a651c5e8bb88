// Based on: W3C PNG specification, section 5.3 (chunk layout).
#include "io/png_fence.h"

#include <cstdint>

namespace lumel {
namespace {

constexpr std::size_t kSignatureSize = 8, kChunkHeaderSize = 8, kChecksumSize = 4;
constexpr std::uint32_t kEnd = 0x49454e44;  // IEND

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint32_t>(bytes[at + i]);
    return value;
}

}  // namespace

Status check_png_chunks(std::span<const std::byte> png, const std::string& where) {
    std::size_t at = kSignatureSize;
    while (at < png.size() && png.size() - at >= kChunkHeaderSize) {
        const std::size_t length = big_endian(png, at);
        const std::uint32_t type = big_endian(png, at + 4);
        at += kChunkHeaderSize;
        if (type == kEnd) return success();
        if (length > png.size() - at)
            return Error{ErrorCode::invalid_input, "cannot be decoded: a chunk leaves the file", where,
                         "the image is damaged; save it again as plain PNG or JPEG"};
        at += length + kChecksumSize;
    }
    return success();  // the decoder notices a missing end by itself
}

}  // namespace lumel
