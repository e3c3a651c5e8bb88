// The texels of a chart as bits, and the eight ways to lay them on a page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lumel {

// Rows of bits, each row starting a new word; bit x of a row is bit x % 64 of word x / 64. Bits beyond the width are 0.
struct ChartMask {
    std::uint32_t width = 0, height = 0, words_per_row = 0;
    std::uint64_t used = 0;     // bits set
    std::uint64_t covered = 0;  // those whose own square meets the chart: what becomes a texel of the bake
    std::vector<std::uint64_t> bits;

    ChartMask() = default;
    ChartMask(std::uint32_t w, std::uint32_t h)
        : width(w), height(h), words_per_row((w + 63) / 64), bits(std::size_t{words_per_row} * h, 0) {}

    static std::uint64_t bytes_of(std::uint32_t w, std::uint32_t h) { return std::uint64_t{(w + 63) / 64} * 8 * h; }

    [[nodiscard]] bool get(std::uint32_t x, std::uint32_t y) const {
        return (bits[std::size_t{y} * words_per_row + x / 64] >> (x % 64)) & 1;
    }
    void set(std::uint32_t x, std::uint32_t y) {
        bits[std::size_t{y} * words_per_row + x / 64] |= std::uint64_t{1} << (x % 64);
    }
    // Sets x0 .. x1 - 1 of a row.
    void set_span(std::uint32_t y, std::uint32_t x0, std::uint32_t x1);
    [[nodiscard]] std::uint64_t count() const;  // bits set
    [[nodiscard]] bool is_rectangle() const { return used == std::uint64_t{width} * height; }
};

// The same texels, whatever is covered.
bool same_texels(const ChartMask& a, const ChartMask& b);

// A chart on a page is transposed first (x, y swapped), then mirrored left to right, then top to bottom: any sum of
// these, 0..7. With W and H the size after the transposition, texel (x, y) of the mask becomes
//   (a, b) = transposed ? (y, x) : (x, y);  (mirrored in x ? W - 1 - a : a,  mirrored in y ? H - 1 - b : b).
inline constexpr std::uint8_t kMirrorX = 1, kMirrorY = 2, kTranspose = 4, kOrientations = 8;
ChartMask oriented(const ChartMask& mask, std::uint8_t orientation);

}  // namespace lumel
