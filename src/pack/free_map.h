// The free texels of a page, and of each texel whether a free square of 2, 3, 4 .. texels begins there: what a search
// needs to test 256 positions of a chart at once.
//
// Level k has bit (x, y) set where the square of side kSquareSides[k] with its top left corner at (x, y) is free and on
// the page. A chart is covered by a few such squares (cover.h): it fits at (x, y) where the bits of all of them are
// set, so the rows of bits, shifted and joined by AND, answer for all x of a row. Two summaries, a bit per 64 positions
// of a row (more on wide pages) and a bit per row, skip what is full.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pack/cover.h"
#include "pack/mask.h"

namespace lumel {

class FreeMap {
public:
    static constexpr std::uint32_t kBlockWords = 4, kBlockBits = 64 * kBlockWords;
    static constexpr std::uint32_t kMaxWidth = 64 * kBlockBits;
    // Rows around the page that may be read, never free; so may 64 texels to the left and 320 to the right.
    static constexpr std::uint32_t kRowsAbove = 2, kRowsBelow = 16;

    // Nothing is free from row `height` on; rows take memory as they are reached. Width at most kMaxWidth.
    FreeMap(std::uint32_t width, std::uint32_t height, std::uint32_t max_level);

    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    [[nodiscard]] std::uint32_t max_level() const { return static_cast<std::uint32_t>(levels_.size()) - 1; }
    [[nodiscard]] std::uint32_t stride() const { return stride_; }  // words from row to row
    // Positions that a bit of units() stands for, as a power of two: 64 to a block of 256.
    [[nodiscard]] std::uint32_t unit_shift() const { return unit_shift_; }

    // Bytes of a row.
    [[nodiscard]] static std::uint64_t row_bytes(std::uint32_t width, std::uint32_t max_level) {
        return std::uint64_t{max_level + 1} * 8 * (words_per_row(width) + 1);
    }

    // Makes rows up to this one exist; invalidates pointers. Searches may look only at rows that exist.
    void reach(std::uint32_t row);

    // Takes the texels of a mask, which must be free. Levels above `max_level` are left behind: not to be used again.
    void take(const ChartMask& mask, std::uint32_t x, std::uint32_t y, std::uint32_t max_level);

    // Word 0 holds x = 0..63 of a row; rows from -kRowsAbove on.
    [[nodiscard]] const std::uint64_t* row(std::uint32_t level, std::int64_t y) const {
        return levels_[level].bits.data() + offset(y);
    }
    [[nodiscard]] std::uint64_t* texels(std::int64_t y) { return levels_[0].bits.data() + offset(y); }
    // A word per row. Bit u: some of the positions u << unit_shift() and up to the next unit is free.
    [[nodiscard]] const std::uint64_t* units(std::uint32_t level) const { return levels_[level].units.data(); }
    // Bit per row: some position is.
    [[nodiscard]] const std::vector<std::uint64_t>& rows(std::uint32_t level) const { return levels_[level].rows; }

private:
    struct Level {
        std::vector<std::uint64_t> bits, units, rows;
    };
    [[nodiscard]] std::size_t offset(std::int64_t y) const {
        return static_cast<std::size_t>(y + kRowsAbove) * stride_ + 1;
    }
    // A word to the left, a block and a word to the right: room for what shifts bring in.
    static constexpr std::uint32_t words_per_row(std::uint32_t width) {
        return ((width + kBlockBits - 1) / kBlockBits + 1) * kBlockWords + 2;
    }
    void free_rows(std::uint32_t level, std::uint32_t first, std::uint32_t end);
    void summarise(std::uint32_t level, std::uint32_t y, std::uint32_t x0, std::uint32_t x1);
    void shrink(std::uint32_t level, std::uint32_t x0, std::uint32_t x1, std::uint32_t y0, std::uint32_t y1);

    std::uint32_t width_, height_, stride_, unit_shift_, rows_ = 0;
    std::vector<Level> levels_;
};

}  // namespace lumel
