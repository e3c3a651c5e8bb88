// PFM: a text header, then raw floats, the bottom row first.
#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

// Words of the header are separated by single white space; the pixels begin right after the third one's.
std::string_view next_word(std::string_view& text) {
    const std::size_t end = text.find_first_of(" \n\r\t");
    if (end == std::string_view::npos) return {};
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end + 1);
    return word;
}

template <class T>
bool parse(std::string_view word, T& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size();
}

float read_float(const char* bytes, bool little) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= std::uint32_t{static_cast<std::uint8_t>(bytes[little ? i : 3 - i])} << (8 * i);
    return std::bit_cast<float>(bits);
}

}  // namespace

Result<Image> decode_pfm(std::span<const std::byte> bytes, const std::string& where) {
    const auto damaged = [&](const char* message) {
        return Error{ErrorCode::invalid_input, message, where, "the file is damaged"};
    };
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::uint32_t channels = next_word(text) == "PF" ? 3 : 1;
    std::uint32_t width = 0, height = 0;
    float scale = 0.0f;  // its sign is the byte order
    if (!parse(next_word(text), width) || !parse(next_word(text), height) || !parse(next_word(text), scale))
        return damaged("the header cannot be read");
    LUMEL_TRY_STATUS(check_image_size(width, height, channels, kMaxImageEdge, bytes.size(), where));
    Image image(width, height, channels);
    if (text.size() < image.data.size() * 4) return damaged("ends within the pixels");
    const std::size_t row = std::size_t{width} * channels;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::size_t i = 0; i < row; ++i)
            image.data[(height - 1 - y) * row + i] = read_float(text.data() + (y * row + i) * 4, scale < 0.0f);
    return image;
}

}  // namespace lumel
