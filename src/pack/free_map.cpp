#include "pack/free_map.h"

#include <algorithm>

#include "base/check.h"

namespace lumel {

FreeMap::FreeMap(std::uint32_t width, std::uint32_t height, std::uint32_t max_level)
    : width_(width), height_(height), stride_(words_per_row(width)), unit_shift_(6) {
    LUMEL_CHECK(width > 0 && width <= kMaxWidth && max_level < kSquareSides.size(), width, max_level);
    while ((width - 1) >> unit_shift_ >= 64) ++unit_shift_;
    levels_.resize(max_level + 1);
    reach(1);
}

void FreeMap::reach(std::uint32_t row) {
    // Squares that begin at the last row in use look this far down.
    const std::uint32_t wanted = std::min(row, height_) + kSquareSides[max_level()] + 1;
    if (wanted <= rows_) return;
    const std::uint32_t first = rows_;
    rows_ = std::max(wanted, rows_ + rows_ / 2);
    for (std::uint32_t k = 0; k <= max_level(); ++k) {
        Level& level = levels_[k];
        // The block behind the last row is for reads that start within it.
        level.bits.resize((std::size_t{rows_} + kRowsAbove + kRowsBelow + 1) * stride_, 0);
        level.units.resize(std::size_t{rows_} + 64, 0);
        level.rows.resize(rows_ / 64 + 2, 0);
        free_rows(k, first, rows_);
    }
}

void FreeMap::free_rows(std::uint32_t level, std::uint32_t first, std::uint32_t end) {
    const std::uint32_t size = kSquareSides[level];
    if (size > width_ || size > height_) return;
    const std::uint32_t positions = width_ - size + 1;
    const std::uint32_t units = ((positions - 1) >> unit_shift_) + 1;
    for (std::uint32_t y = first; y < std::min(end, height_ - size + 1); ++y) {
        std::uint64_t* words = levels_[level].bits.data() + offset(y);
        std::fill_n(words, positions / 64, ~std::uint64_t{0});
        if (positions % 64 != 0) words[positions / 64] = (std::uint64_t{1} << (positions % 64)) - 1;
        levels_[level].units[y] = ~std::uint64_t{0} >> (64 - units);
        levels_[level].rows[y / 64] |= std::uint64_t{1} << (y % 64);
    }
}

void FreeMap::take(const ChartMask& mask, std::uint32_t x, std::uint32_t y, std::uint32_t max_level) {
    reach(y + mask.height);
    const std::uint32_t shift = x % 64;
    const std::uint64_t* bits = mask.bits.data();
    for (std::uint32_t r = 0; r < mask.height; ++r, bits += mask.words_per_row) {
        std::uint64_t* words = texels(std::int64_t{y} + r) + x / 64;
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
            words[w] &= ~(bits[w] << shift);
            if (shift != 0) words[w + 1] &= ~(bits[w] >> (64 - shift));
        }
        summarise(0, y + r, x, x + mask.width);
    }
    for (std::uint32_t k = 1; k <= max_level; ++k) {
        const std::uint32_t reach_back = kSquareSides[k] - 1;
        shrink(k, x > reach_back ? x - reach_back : 0, x + mask.width, y > reach_back ? y - reach_back : 0,
               y + mask.height);
    }
}

// A square is free where the four of the next smaller side in its corners are.
void FreeMap::shrink(std::uint32_t level, std::uint32_t x0, std::uint32_t x1, std::uint32_t y0, std::uint32_t y1) {
    const std::uint32_t step = kSquareSides[level] - kSquareSides[level - 1], first = x0 / 64, last = (x1 - 1) / 64;
    const std::size_t down = std::size_t{step} * stride_;
    const std::vector<std::uint64_t>& rows = levels_[level].rows;
    for (std::uint32_t y = y0; y < y1; ++y) {
        if (((rows[y / 64] >> (y % 64)) & 1) == 0) continue;
        std::uint64_t* out = levels_[level].bits.data() + offset(y);
        const std::uint64_t* upper = levels_[level - 1].bits.data() + offset(y);
        const std::uint64_t* lower = upper + down;
        std::uint64_t changed = 0;
        for (std::uint32_t w = first; w <= last; ++w) {
            const std::uint64_t here = upper[w] & lower[w], next = upper[w + 1] & lower[w + 1];
            const std::uint64_t free = out[w] & here & (here >> step | next << (64 - step));
            changed |= out[w] ^ free;
            out[w] = free;
        }
        if (changed != 0) summarise(level, y, x0, x1);
    }
}

void FreeMap::summarise(std::uint32_t level, std::uint32_t y, std::uint32_t x0, std::uint32_t x1) {
    const std::uint64_t* words = row(level, y);
    std::uint64_t& units = levels_[level].units[y];
    const std::uint32_t words_per_unit = 1u << (unit_shift_ - 6);
    for (std::uint32_t u = x0 >> unit_shift_; u <= (x1 - 1) >> unit_shift_; ++u) {
        std::uint64_t free = 0;
        for (std::uint32_t w = 0; w < words_per_unit; ++w) free |= words[std::size_t{u} * words_per_unit + w];
        if (free == 0) units &= ~(std::uint64_t{1} << u);
    }
    if (units == 0) levels_[level].rows[y / 64] &= ~(std::uint64_t{1} << (y % 64));
}

}  // namespace lumel
