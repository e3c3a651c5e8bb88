// Radiance .hdr (RGBE, flat or run-length coded). Based on: Ward 1991, "Real Pixels" (Graphics Gems II), and the format
// notes of Radiance's color.c. Differs: no "+0.5" of Ward's reader; mantissa m and exponent e mean m * 2^(e - 136), as
// writers of today (stb_image_write, OpenCV, Blender) mean it.
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class HdrReader {
public:
    HdrReader(std::span<const std::byte> bytes, const std::string& where) : bytes_(bytes), where_(where) {}

    Result<Image> read() {
        LUMEL_TRY_STATUS(read_header());
        LUMEL_TRY_STATUS(check_image_size(width_, height_, 3, kMaxImageEdge, bytes_.size(), where_));
        Image image(static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_), 3);
        std::vector<Rgbe> row(image.width);
        for (std::uint32_t y = 0; y < image.height; ++y) {
            LUMEL_TRY_STATUS(read_row(row));
            for (std::uint32_t x = 0; x < image.width; ++x)
                store(row[x], image.at(x, bottom_up_ ? image.height - 1 - y : y));
        }
        return image;
    }

private:
    Error damaged(const std::string& message) const {
        return {ErrorCode::invalid_input, message, where_, "the file is damaged"};
    }

    // The next line without its newline; false at the end of the file.
    bool line(std::string_view& out) {
        const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
        const void* end = at_ < bytes_.size() ? std::memchr(begin, '\n', bytes_.size() - at_) : nullptr;
        if (!end) return false;
        out = {begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin)};
        at_ += out.size() + 1;
        return true;
    }

    Status read_header() {
        std::string_view text;
        while (line(text) && !text.empty()) {
            if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe")
                return Error{ErrorCode::unsupported, "its pixels are not RGBE", where_,
                             "convert it to linear Rec. 709 RGBE"};
        }
        if (!line(text)) return damaged("the header does not end");
        return read_resolution(text);
    }

    // "-Y height +X width"; "+Y" turns it upside down. The other six orientations are never written by anyone.
    Status read_resolution(std::string_view text) {
        bottom_up_ = text.starts_with("+Y ");
        if (!bottom_up_ && !text.starts_with("-Y "))
            return Error{ErrorCode::unsupported, "rows of the image are not horizontal", where_,
                         "save it with the resolution line -Y h +X w"};
        text.remove_prefix(3);
        if (!number(text, height_)) return damaged("the image size cannot be read");
        if (!text.starts_with(" +X "))
            return Error{ErrorCode::unsupported, "the image is mirrored", where_,
                         "save it with the resolution line -Y h +X w"};
        text.remove_prefix(4);
        if (!number(text, width_)) return damaged("the image size cannot be read");
        return success();
    }

    static bool number(std::string_view& text, std::uint32_t& value) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{}) return false;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        return true;
    }

    [[nodiscard]] bool has(std::size_t count) const { return bytes_.size() - at_ >= count; }
    std::uint8_t byte() { return static_cast<std::uint8_t>(bytes_[at_++]); }

    Status read_row(std::vector<Rgbe>& row) {
        if (!has(4)) return damaged("ends within the pixels");
        const bool coded = row.size() >= 8 && row.size() < 32768 && bytes_[at_] == std::byte{2} &&
                           bytes_[at_ + 1] == std::byte{2} && (bytes_[at_ + 2] & std::byte{0x80}) == std::byte{0};
        return coded ? read_coded_row(row) : read_flat_row(row);
    }

    // Each of R, G, B, E by itself: a count above 128 repeats one byte, else that many bytes follow.
    Status read_coded_row(std::vector<Rgbe>& row) {
        at_ += 2;
        const std::size_t width = std::size_t{byte()} * 256 + byte();
        if (width != row.size()) return damaged("a row has another length than the image");
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (std::size_t x = 0; x < width;) {
                if (!has(2)) return damaged("ends within the pixels");
                const std::size_t code = byte();
                const bool repeat = code > 128;
                const std::size_t count = repeat ? code - 128 : code;
                if (count == 0 || count > width - x) return damaged("a run leaves its row");
                if (!has(repeat ? 1 : count)) return damaged("ends within the pixels");
                for (std::size_t i = 0; i < count; ++i)
                    row[x++][channel] = static_cast<std::uint8_t>(bytes_[at_ + (repeat ? 0 : i)]);
                at_ += repeat ? 1 : count;
            }
        }
        return success();
    }

    // Pixels as they are; in the old run-length code (1, 1, 1, n) repeats the last pixel n times, shifted by 8 bits for
    // each such code in a row.
    Status read_flat_row(std::vector<Rgbe>& row) {
        unsigned shift = 0;
        for (std::size_t x = 0; x < row.size();) {
            if (!has(4)) return damaged("ends within the pixels");
            const Rgbe pixel{byte(), byte(), byte(), byte()};
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1 || x == 0) {
                row[x++] = pixel;
                shift = 0;
                continue;
            }
            const std::size_t count = shift < 24 ? std::size_t{pixel[3]} << shift : row.size() + 1;
            if (count > row.size() - x) return damaged("a run leaves its row");
            for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
            shift += 8;
        }
        return success();
    }

    static void store(const Rgbe& pixel, float* out) {
        const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, int{pixel[3]} - 136);
        for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<float>(pixel[c]) * scale;
    }

    std::span<const std::byte> bytes_;
    std::string where_;
    std::size_t at_ = 0;
    std::uint32_t width_ = 0, height_ = 0;
    bool bottom_up_ = false;
};

}  // namespace

Result<Image> decode_hdr(std::span<const std::byte> bytes, const std::string& where) {
    return HdrReader(bytes, where).read();
}

}  // namespace lumel
