// The fourteen block layouts of BC6H.
// Based on: Khronos Data Format Specification 1.3, table "Bit interpretations for BC6H modes"; the layouts below are
// in its notation.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace lumel {

inline constexpr unsigned kBc6hModes = 14;

// Part of one number: `count` bits of end point `end` (0 and 1 of region 0, 2 and 3 of region 1), channel `channel`,
// from bit `low` up; stored from the top down where `reversed`.
struct Bc6hField {
    std::uint8_t end = 0, channel = 0, low = 0, count = 0;
    bool reversed = false;
};

struct Bc6hMode {
    std::uint8_t code = 0, code_bits = 0;
    std::uint8_t regions = 1;
    std::uint8_t end_bits = 0;                    // of the first end point, and of the others where not transformed
    std::array<std::uint8_t, 3> other_bits = {};  // of the others, per channel
    bool transformed = false;                     // the others are stored as differences from the first
    std::array<Bc6hField, 32> fields = {};
    std::uint8_t field_count = 0;

    [[nodiscard]] constexpr unsigned index_bits() const { return regions == 2 ? 3 : 4; }
};

namespace detail {

// "rw9:0": bits 9 to 0 of red of end point w, least significant first; "rw10:15" is stored from bit 15 down.
constexpr Bc6hMode bc6h_mode(std::uint8_t code, std::uint8_t code_bits, std::uint8_t regions, std::uint8_t end_bits,
                             std::array<std::uint8_t, 3> other_bits, bool transformed, std::string_view layout) {
    Bc6hMode mode{code, code_bits, regions, end_bits, other_bits, transformed, {}, 0};
    std::size_t at = 0;
    const auto number = [&] {
        unsigned value = 0;
        for (; at < layout.size() && layout[at] >= '0' && layout[at] <= '9'; ++at)
            value = value * 10 + static_cast<unsigned>(layout[at] - '0');
        return value;
    };
    while (at < layout.size()) {
        Bc6hField field;
        field.channel = layout[at] == 'r' ? 0 : layout[at] == 'g' ? 1 : 2;
        field.end = static_cast<std::uint8_t>(layout[at + 1] - 'w');
        at += 2;
        const unsigned first = number();
        unsigned second = first;
        if (at < layout.size() && layout[at] == ':') {
            ++at;
            second = number();
        }
        field.reversed = first < second;
        field.low = static_cast<std::uint8_t>(first < second ? first : second);
        field.count = static_cast<std::uint8_t>((first < second ? second - first : first - second) + 1);
        mode.fields[mode.field_count++] = field;
        ++at;  // the space
    }
    return mode;
}

}  // namespace detail

// In the order of the specification: modes 1 to 14.
inline constexpr std::array<Bc6hMode, kBc6hModes> kBc6hModeTable = {
    detail::bc6h_mode(0b00, 2, 2, 10, {5, 5, 5}, true,
                      "gy4 by4 bz4 rw9:0 gw9:0 bw9:0 rx4:0 gz4 gy3:0 gx4:0 bz0 gz3:0 bx4:0 bz1 by3:0 ry4:0 bz2 rz4:0 "
                      "bz3"),
    detail::bc6h_mode(0b01, 2, 2, 7, {6, 6, 6}, true,
                      "gy5 gz4 gz5 rw6:0 bz0 bz1 by4 gw6:0 by5 bz2 gy4 bw6:0 bz3 bz5 bz4 rx5:0 gy3:0 gx5:0 gz3:0 bx5:0 "
                      "by3:0 ry5:0 rz5:0"),
    detail::bc6h_mode(0b00010, 5, 2, 11, {5, 4, 4}, true,
                      "rw9:0 gw9:0 bw9:0 rx4:0 rw10 gy3:0 gx3:0 gw10 bz0 gz3:0 bx3:0 bw10 bz1 by3:0 ry4:0 bz2 rz4:0 "
                      "bz3"),
    detail::bc6h_mode(0b00110, 5, 2, 11, {4, 5, 4}, true,
                      "rw9:0 gw9:0 bw9:0 rx3:0 rw10 gz4 gy3:0 gx4:0 gw10 gz3:0 bx3:0 bw10 bz1 by3:0 ry3:0 bz0 bz2 "
                      "rz3:0 gy4 bz3"),
    detail::bc6h_mode(0b01010, 5, 2, 11, {4, 4, 5}, true,
                      "rw9:0 gw9:0 bw9:0 rx3:0 rw10 by4 gy3:0 gx3:0 gw10 bz0 gz3:0 bx4:0 bw10 by3:0 ry3:0 bz1 bz2 "
                      "rz3:0 bz4 bz3"),
    detail::bc6h_mode(0b01110, 5, 2, 9, {5, 5, 5}, true,
                      "rw8:0 by4 gw8:0 gy4 bw8:0 bz4 rx4:0 gz4 gy3:0 gx4:0 bz0 gz3:0 bx4:0 bz1 by3:0 ry4:0 bz2 rz4:0 "
                      "bz3"),
    detail::bc6h_mode(0b10010, 5, 2, 8, {6, 5, 5}, true,
                      "rw7:0 gz4 by4 gw7:0 bz2 gy4 bw7:0 bz3 bz4 rx5:0 gy3:0 gx4:0 bz0 gz3:0 bx4:0 bz1 by3:0 ry5:0 "
                      "rz5:0"),
    detail::bc6h_mode(0b10110, 5, 2, 8, {5, 6, 5}, true,
                      "rw7:0 bz0 by4 gw7:0 gy5 gy4 bw7:0 gz5 bz4 rx4:0 gz4 gy3:0 gx5:0 gz3:0 bx4:0 bz1 by3:0 ry4:0 bz2 "
                      "rz4:0 bz3"),
    detail::bc6h_mode(0b11010, 5, 2, 8, {5, 5, 6}, true,
                      "rw7:0 bz1 by4 gw7:0 by5 gy4 bw7:0 bz5 bz4 rx4:0 gz4 gy3:0 gx4:0 bz0 gz3:0 bx5:0 by3:0 ry4:0 bz2 "
                      "rz4:0 bz3"),
    detail::bc6h_mode(0b11110, 5, 2, 6, {6, 6, 6}, false,
                      "rw5:0 gz4 bz0 bz1 by4 gw5:0 gy5 by5 bz2 gy4 bw5:0 gz5 bz3 bz5 bz4 rx5:0 gy3:0 gx5:0 gz3:0 bx5:0 "
                      "by3:0 ry5:0 rz5:0"),
    detail::bc6h_mode(0b00011, 5, 1, 10, {10, 10, 10}, false, "rw9:0 gw9:0 bw9:0 rx9:0 gx9:0 bx9:0"),
    detail::bc6h_mode(0b00111, 5, 1, 11, {9, 9, 9}, true, "rw9:0 gw9:0 bw9:0 rx8:0 rw10 gx8:0 gw10 bx8:0 bw10"),
    detail::bc6h_mode(0b01011, 5, 1, 12, {8, 8, 8}, true,
                      "rw9:0 gw9:0 bw9:0 rx7:0 rw10:11 gx7:0 gw10:11 bx7:0 bw10:11"),
    detail::bc6h_mode(0b01111, 5, 1, 16, {4, 4, 4}, true,
                      "rw9:0 gw9:0 bw9:0 rx3:0 rw10:15 gx3:0 gw10:15 bx3:0 bw10:15"),
};

}  // namespace lumel
