// Base64, percent escapes and what a relative URI may name.
#include "io/data_uri.h"

#include <array>
#include <cstdint>

#include "io/json_read.h"

namespace lumel {
namespace {

constexpr std::uint8_t kNotBase64 = 255;

constexpr std::array<std::uint8_t, 256> make_base64_table() {
    std::array<std::uint8_t, 256> table{};
    for (std::uint8_t& value : table) value = kNotBase64;
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kDigits.size(); ++i)
        table[static_cast<std::uint8_t>(kDigits[i])] = static_cast<std::uint8_t>(i);
    return table;
}

// False at the first character that is not base64.
bool decode_base64(std::string_view text, std::vector<std::byte>& out) {
    static constexpr std::array<std::uint8_t, 256> kTable = make_base64_table();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    out.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    unsigned have = 0;
    for (const char c : text) {
        const std::uint8_t digit = kTable[static_cast<std::uint8_t>(c)];
        if (digit == kNotBase64) return false;
        bits = (bits << 6 | digit) & 0xffffff;
        have += 6;
        if (have < 8) continue;
        have -= 8;
        out.push_back(static_cast<std::byte>(bits >> have & 0xff));
    }
    return true;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string decode_percent(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape =
            text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
        if (!escape) {
            out += text[i];
            continue;
        }
        out += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
        i += 2;
    }
    return out;
}

}  // namespace

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri, const std::string& where) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        return unsupported(where, "its data: URI is not base64");
    std::vector<std::byte> bytes;
    if (!decode_base64(uri.substr(comma + 1), bytes))
        return invalid(where, "its data: URI holds characters that are not base64");
    return bytes;
}

Result<std::filesystem::path> resolve_uri(std::string_view uri, const std::filesystem::path& directory,
                                          const std::string& where) {
    const std::string name = decode_percent(uri);
    if (directory.empty()) return unsupported(where, "refers to the file '" + name + "', but files are not read here");
    if (name.empty() || name.find('\0') != std::string::npos)
        return invalid(where, "its URI is empty or holds a zero byte");
    const std::filesystem::path path = name;
    const std::size_t colon = name.find(':');
    if (path.is_absolute() || (colon != std::string::npos && colon < name.find('/')))
        return unsupported(where, "refers to '" + name + "'; only paths relative to the scene are read",
                           "copy the file beside the scene");
    return directory / path;
}

}  // namespace lumel
