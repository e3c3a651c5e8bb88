#include "pack/mask.h"

#include <bit>

namespace lumel {

void ChartMask::set_span(std::uint32_t y, std::uint32_t x0, std::uint32_t x1) {
    std::uint64_t* row = &bits[std::size_t{y} * words_per_row];
    const std::uint32_t first = x0 / 64, last = (x1 - 1) / 64;
    const std::uint64_t head = ~std::uint64_t{0} << (x0 % 64), tail = ~std::uint64_t{0} >> (63 - (x1 - 1) % 64);
    if (first == last) {
        row[first] |= head & tail;
        return;
    }
    row[first] |= head;
    for (std::uint32_t w = first + 1; w < last; ++w) row[w] = ~std::uint64_t{0};
    row[last] |= tail;
}

std::uint64_t ChartMask::count() const {
    std::uint64_t set = 0;
    for (const std::uint64_t word : bits) set += static_cast<std::uint64_t>(std::popcount(word));
    return set;
}

bool same_texels(const ChartMask& a, const ChartMask& b) {
    return a.width == b.width && a.height == b.height && a.bits == b.bits;
}

ChartMask oriented(const ChartMask& mask, std::uint8_t orientation) {
    if (orientation == 0) return mask;
    const bool transposed = (orientation & kTranspose) != 0;
    ChartMask out(transposed ? mask.height : mask.width, transposed ? mask.width : mask.height);
    out.used = mask.used;
    out.covered = mask.covered;
    for (std::uint32_t y = 0; y < mask.height; ++y)
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w)
            for (std::uint64_t left = mask.bits[std::size_t{y} * mask.words_per_row + w]; left != 0; left &= left - 1) {
                const std::uint32_t x = w * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
                const std::uint32_t a = transposed ? y : x, b = transposed ? x : y;
                out.set((orientation & kMirrorX) != 0 ? out.width - 1 - a : a,
                        (orientation & kMirrorY) != 0 ? out.height - 1 - b : b);
            }
    return out;
}

}  // namespace lumel
