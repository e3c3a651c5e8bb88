// Based on: ITU-T T.81, annex B (markers and table segments).
#include "io/jpeg_fence.h"

#include <cstdint>

#include "base/try.h"

namespace lumel {
namespace {

constexpr std::uint8_t kEnd = 0xd9, kHuffmanTables = 0xc4;

bool has_no_length(std::uint8_t marker) { return marker == 0x01 || (marker >= 0xd0 && marker <= kEnd); }

// Walks markers as the decoder does: segments are skipped by their length; between them, and within the coded data of a
// scan, the next marker is the next 0xff with neither 0xff nor (in a scan) 0x00 behind it.
class MarkerWalk {
public:
    MarkerWalk(std::span<const std::byte> bytes, const std::string& where) : bytes_(bytes), where_(where) {}

    Status check() {
        std::uint8_t marker = 0;
        while (next_marker(marker)) {
            if (marker == kEnd) return success();
            if (has_no_length(marker)) continue;
            LUMEL_TRY_STATUS(check_segment(marker));
        }
        return success();  // the decoder notices a missing end by itself
    }

private:
    [[nodiscard]] std::uint8_t byte(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }

    bool next_marker(std::uint8_t& marker) {
        while (at_ + 1 < bytes_.size()) {
            const bool found = byte(at_) == 0xff && byte(at_ + 1) != 0xff && byte(at_ + 1) != 0x00;
            if (!found) {
                ++at_;
                continue;
            }
            marker = byte(at_ + 1);
            at_ += 2;
            return true;
        }
        return false;
    }

    Status check_segment(std::uint8_t marker) {
        const std::size_t left = bytes_.size() - at_;
        const std::size_t length = left < 2 ? 0 : std::size_t{byte(at_)} * 256 + byte(at_ + 1);
        if (length < 2 || length > left) return damaged("a segment leaves the file");
        if (marker == kHuffmanTables) LUMEL_TRY_STATUS(check_tables(at_ + 2, at_ + length));
        at_ += length;
        return success();
    }

    // Each table: class and number, 16 counts of symbols by length, the symbols.
    Status check_tables(std::size_t at, std::size_t end) const {
        while (at < end) {
            if (end - at < 17) return damaged("a Huffman table is cut off");
            std::size_t symbols = 0;
            for (std::size_t i = 1; i <= 16; ++i) symbols += byte(at + i);
            if (symbols > 256 || symbols > end - at - 17) return damaged("a Huffman table has too many symbols");
            at += 17 + symbols;
        }
        return success();
    }

    Error damaged(const char* message) const {
        return {ErrorCode::invalid_input, std::string("cannot be decoded: ") + message, where_,
                "the image is damaged; save it again as plain PNG or JPEG"};
    }

    std::span<const std::byte> bytes_;
    const std::string& where_;
    std::size_t at_ = 0;
};

}  // namespace

Status check_jpeg_tables(std::span<const std::byte> jpeg, const std::string& where) {
    return MarkerWalk(jpeg, where).check();
}

}  // namespace lumel
