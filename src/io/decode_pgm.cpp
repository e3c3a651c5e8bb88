// Binary PGM (P5) and PPM (P6), 8 or 16 bits: masks of reference data come as these.
#include <charconv>
#include <string_view>

#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

// The next number of the header; comments run from # to the end of the line. Leaves `text` behind the number.
bool next_number(std::string_view& text, std::uint32_t& value) {
    for (;;) {
        const std::size_t start = text.find_first_not_of(" \t\r\n");
        if (start == std::string_view::npos) return false;
        text.remove_prefix(start);
        if (text.front() != '#') break;
        const std::size_t line = text.find('\n');
        if (line == std::string_view::npos) return false;
        text.remove_prefix(line);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

}  // namespace

Result<Image> decode_pgm(std::span<const std::byte> bytes, const std::string& where) {
    const auto damaged = [&](const char* message) {
        return Error{ErrorCode::invalid_input, message, where, "the file is damaged"};
    };
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::uint32_t channels = text.substr(0, 2) == "P6" ? 3 : 1;
    text.remove_prefix(2);
    std::uint32_t width = 0, height = 0, largest = 0;
    if (!next_number(text, width) || !next_number(text, height) || !next_number(text, largest) || text.empty())
        return damaged("the header cannot be read");
    if (largest == 0 || largest > 65535) return damaged("the largest value must lie between 1 and 65535");
    text.remove_prefix(1);  // one white space ends the header
    LUMEL_TRY_STATUS(check_image_size(width, height, channels, kMaxImageEdge, bytes.size(), where));
    Image image(width, height, channels);
    const std::size_t size = largest > 255 ? 2 : 1;
    if (text.size() < image.data.size() * size) return damaged("ends within the pixels");
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const auto byte = [&](std::size_t k) {
            return static_cast<std::uint32_t>(static_cast<std::uint8_t>(text[i * size + k]));
        };
        const std::uint32_t value = size == 2 ? (byte(0) << 8 | byte(1)) : byte(0);
        image.data[i] = static_cast<float>(value) / static_cast<float>(largest);
    }
    return image;
}

}  // namespace lumel
