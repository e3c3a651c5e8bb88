#include "pack/cover.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace lumel {
namespace {

// Starts of squares of this side along a length: side by side, the last one moved back to end with it.
std::vector<std::uint32_t> starts(std::uint32_t length, std::uint32_t side) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t at = 0; at + side < length; at += side) out.push_back(at);
    out.push_back(length - side);
    return out;
}

std::vector<CoverSquare> cover_rectangle(const ChartMask& mask, std::uint32_t max_level) {
    const std::uint32_t shorter = std::min(mask.width, mask.height);
    const std::uint32_t level = std::min(max_level, square_level(shorter)), side = kSquareSides[level];
    std::vector<CoverSquare> out;
    for (const std::uint32_t y : starts(mask.height, side))
        for (const std::uint32_t x : starts(mask.width, side)) out.push_back({level, x, y});
    // What is most unlikely to be free with the first corner is the one opposite.
    if (out.size() > 2) std::swap(out[1], out.back());
    return out;
}

// Where squares begin inside a mask whose side is larger by `step`, given where those of the smaller side do.
ChartMask larger_squares(const ChartMask& squares, std::uint32_t step) {
    ChartMask out(squares.width, squares.height);
    const std::uint32_t words = squares.words_per_row, skip = step / 64, shift = step % 64;
    const auto shifted = [&](std::uint32_t y, std::uint32_t w) {
        const std::uint64_t* row = &squares.bits[std::size_t{y} * words];
        const std::uint64_t low = w + skip < words ? row[w + skip] : 0;
        const std::uint64_t high = w + skip + 1 < words ? row[w + skip + 1] : 0;
        return shift == 0 ? low : low >> shift | high << (64 - shift);
    };
    for (std::uint32_t y = 0; y + step < squares.height; ++y)
        for (std::uint32_t w = 0; w < words; ++w)
            out.bits[std::size_t{y} * words + w] = squares.bits[std::size_t{y} * words + w] &
                                                   squares.bits[std::size_t{y + step} * words + w] & shifted(y, w) &
                                                   shifted(y + step, w);
    return out;
}

class Coverer {
public:
    Coverer(const ChartMask& mask, const std::function<bool()>& cancelled) : left_(mask), cancelled_(cancelled) {}

    std::vector<CoverSquare> run(std::uint32_t max_level) {
        std::vector<ChartMask> squares{left_};
        while (squares.size() <= max_level && !cancelled_()) {
            ChartMask larger =
                larger_squares(squares.back(), kSquareSides[squares.size()] - kSquareSides[squares.size() - 1]);
            if (larger.count() == 0) break;
            squares.push_back(std::move(larger));
        }
        for (std::size_t level = squares.size(); level-- > 0;) {
            take_squares(squares[level], static_cast<std::uint32_t>(level));
            squares.pop_back();
        }
        return std::move(out_);
    }

private:
    // Those whose corner is not covered yet and that cover a quarter of their own area anew.
    void take_squares(const ChartMask& squares, std::uint32_t level) {
        const std::uint32_t side = kSquareSides[level], enough = (side * side + 3) / 4;
        for (std::uint32_t y = 0; y < squares.height && !cancelled_(); ++y)
            for (std::uint32_t w = 0; w < squares.words_per_row; ++w) {
                const std::size_t word = std::size_t{y} * squares.words_per_row + w;
                std::uint64_t tried = 0;
                while (const std::uint64_t open = squares.bits[word] & left_.bits[word] & ~tried) {
                    const auto bit = static_cast<std::uint32_t>(std::countr_zero(open));
                    tried |= std::uint64_t{1} << bit;
                    const std::uint32_t x = w * 64 + bit;
                    if (each_word<false>(x, y, side) < enough) continue;
                    each_word<true>(x, y, side);
                    out_.push_back({level, x, y});
                }
            }
    }

    // Counts the texels of a square that are left, or clears them.
    template <bool clear>
    std::uint32_t each_word(std::uint32_t x, std::uint32_t y, std::uint32_t side) {
        std::uint32_t count = 0;
        for (std::uint32_t r = y; r < y + side; ++r)
            for (std::uint32_t at = x; at < x + side;) {
                const std::uint32_t bit = at % 64, n = std::min(64 - bit, x + side - at);
                const std::uint64_t ones = (~std::uint64_t{0} >> (64 - n)) << bit;
                std::uint64_t& word = left_.bits[std::size_t{r} * left_.words_per_row + at / 64];
                if constexpr (clear)
                    word &= ~ones;
                else
                    count += static_cast<std::uint32_t>(std::popcount(word & ones));
                at += n;
            }
        return count;
    }

    ChartMask left_;  // texels that no square covers yet
    const std::function<bool()>& cancelled_;
    std::vector<CoverSquare> out_;
};

}  // namespace

std::vector<CoverSquare> cover(const ChartMask& mask, std::uint32_t max_level, const std::function<bool()>& cancelled) {
    return mask.is_rectangle() ? cover_rectangle(mask, max_level) : Coverer(mask, cancelled).run(max_level);
}

}  // namespace lumel
