#include "pack/sweep.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <tuple>

#include "base/check.h"

namespace lumel {

void PageBits::grow(std::uint32_t rows) {
    if (rows <= rows_) return;
    rows_ = std::max(rows, rows_ + rows_ / 2);
    bits_.resize(std::size_t{rows_} * words_per_row_, 0);
}

// 0 where the texel is free, else how many taken texels follow from it within 64.
std::uint32_t PageBits::skip_taken(std::uint32_t x, std::uint32_t y) const {
    const std::uint64_t* word = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    return static_cast<std::uint32_t>(std::countr_one(word[0] >> (x % 64)));
}

bool PageBits::fits(const ChartMask& mask, std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t shift = x % 64;
    const std::uint64_t* page = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    const std::uint64_t* row = mask.bits.data();
    for (std::uint32_t r = 0; r < mask.height; ++r, page += words_per_row_, row += mask.words_per_row)
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
            const std::uint64_t taken = shift == 0 ? page[w] : page[w] >> shift | page[w + 1] << (64 - shift);
            if (taken & row[w]) return false;
        }
    return true;
}

PageBits::Spot PageBits::find(const ChartMask& mask, std::uint32_t start_row, std::uint32_t height) {
    if (mask.width > width_ || mask.height > height) return {};
    // Every position needs the texel under the first one of the mask's top row.
    std::uint32_t lead = 0;
    while (lead + 1 < mask.width && !mask.get(lead, 0)) ++lead;
    for (std::uint32_t y = start_row; y + mask.height <= height; ++y) {
        grow(y + mask.height);
        for (std::uint32_t x = 0; x + mask.width <= width_;) {
            if (const std::uint32_t taken = skip_taken(x + lead, y)) {
                x += taken;
                continue;
            }
            if (fits(mask, x, y)) return {true, x, y};
            ++x;
        }
    }
    return {};
}

void PageBits::set(const ChartMask& mask, std::uint32_t x, std::uint32_t y) {
    grow(y + mask.height);
    const std::uint32_t shift = x % 64;
    std::uint64_t* page = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    const std::uint64_t* row = mask.bits.data();
    for (std::uint32_t r = 0; r < mask.height; ++r, page += words_per_row_, row += mask.words_per_row)
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
            page[w] |= row[w] << shift;
            if (shift != 0) page[w + 1] |= row[w] >> (64 - shift);
        }
}

PageFill sweep_page(std::span<const ChartMask> masks, std::span<const std::uint32_t> mask_of, std::uint32_t width,
                    const Context& context) {
    std::vector<std::uint32_t> order(mask_of.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t chart) {
        const ChartMask& m = masks[mask_of[chart]];
        return std::pair(m.width + m.height, m.height);
    };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) > key(b); });
    PageFill out;
    out.spots.resize(mask_of.size());
    PageBits page(width);
    std::uint32_t start_row = 0, last_size = std::numeric_limits<std::uint32_t>::max();
    for (const std::uint32_t chart : order) {
        if (out.placed % 256 == 0 && context.cancelled()) break;
        const ChartMask& m = masks[mask_of[chart]];
        if (m.width + m.height < last_size) start_row = 0, last_size = m.width + m.height;
        const PageBits::Spot spot = page.find(m, start_row, std::numeric_limits<std::uint32_t>::max());
        LUMEL_CHECK(spot.found, chart, m.width);
        page.set(m, spot.x, spot.y);
        start_row = spot.y;
        out.spots[chart] = {true, 0, spot.x, spot.y};
        out.height = std::max(out.height, spot.y + m.height);
        out.used += m.used;
        ++out.placed;
    }
    return out;
}

}  // namespace lumel
