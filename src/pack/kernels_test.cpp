// Every set of instructions against plain references; next_fit is tested with the free map.
#include "pack/kernels.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/statistics.h"

namespace lumel {
namespace {

std::uint64_t random_word(test::Random& random) { return std::uint64_t{random.bits()} << 32 | random.bits(); }

std::vector<const Kernels*> sets() {
    std::size_t count = 0;
    const Kernels* const* all = all_kernels(count);
    return {all, all + count};
}

// A picture of texels that answers for places off it, too.
struct Texels {
    std::int32_t width, height;
    std::vector<std::uint8_t> set;

    Texels(std::int32_t w, std::int32_t h) : width(w), height(h), set(static_cast<std::size_t>(w) * h, 0) {}
    [[nodiscard]] bool get(std::int32_t x, std::int32_t y) const {
        return x >= 0 && y >= 0 && x < width && y < height && set[static_cast<std::size_t>(y) * width + x] != 0;
    }
    // Part of a square of this side that is set as a whole.
    [[nodiscard]] bool in_square(std::int32_t x, std::int32_t y, std::int32_t side) const {
        for (std::int32_t y0 = y - side + 1; y0 <= y; ++y0)
            for (std::int32_t x0 = x - side + 1; x0 <= x; ++x0) {
                bool all = true;
                for (std::int32_t i = 0; i < side * side; ++i) all &= get(x0 + i % side, y0 + i / side);
                if (all) return true;
            }
        return false;
    }
};

TEST(Kernels, RateCountsWhatAPlaceStrandsAndLeavesOpen) {
    test::Random random(11);
    std::int32_t stranded_anywhere = 0;
    for (int n = 0; n < 200; ++n) {
        // A frame of one or two columns around a mask, its rim and sides of any texels: the kernel takes them as given.
        const std::uint32_t columns = 1 + random.bits() % 2, rows = 5 + random.bits() % 20;
        const auto width = static_cast<std::int32_t>(64 * columns), height = static_cast<std::int32_t>(rows);
        std::vector<std::uint64_t> mask((columns + 2) * rows, 0), rim = mask, side = mask;
        const std::size_t stride = columns + 3;
        std::vector<std::uint64_t> page(stride * rows);
        for (std::uint64_t& word : page) word = random_word(random) | random_word(random) | random_word(random);
        const std::uint32_t shift = n % 4 == 0 ? 0 : random.bits() % 64;
        Texels before(width, height), after(width, height);
        for (std::uint32_t r = 0; r < rows; ++r)
            for (std::uint32_t c = 1; c <= columns; ++c) {
                const std::size_t i = c * rows + r;
                // Not in the outermost texels, where no chart is.
                const bool inside = r > 1 && r + 2 < rows;
                mask[i] = inside ? random_word(random) & random_word(random) : 0;
                if (c == 1) mask[i] &= ~std::uint64_t{3};
                if (c == columns) mask[i] &= ~std::uint64_t{0} >> 2;
                rim[i] = random_word(random) & ~mask[i];
                side[i] = random_word(random) & rim[i];
                // The outermost ring is beyond the rim.
                if (r == 0 || r + 1 == rows) rim[i] = side[i] = 0;
                if (c == 1) rim[i] &= ~std::uint64_t{1};
                if (c == columns) rim[i] &= ~std::uint64_t{0} >> 1;
                for (std::uint32_t bit = 0; bit < 64; ++bit) {
                    const std::uint32_t x = (c - 1) * 64 + bit, at = x + shift;
                    const bool free = page[r * stride + at / 64] >> (at % 64) & 1;
                    before.set[r * 64 * columns + x] = free;
                    after.set[r * 64 * columns + x] = free && !(mask[i] >> bit & 1);
                }
            }
        FrameRating expected;
        for (std::int32_t y = 0; y < height; ++y)
            for (std::int32_t x = 0; x < width; ++x) {
                const std::size_t i = (static_cast<std::size_t>(x) / 64 + 1) * rows + static_cast<std::size_t>(y);
                const auto is_set = [&](const std::vector<std::uint64_t>& bits) { return bits[i] >> (x % 64) & 1; };
                if (is_set(side)) expected.open += before.get(x, y);
                if (!is_set(rim)) continue;
                expected.stranded += after.get(x, y) && !after.in_square(x, y, 2);
                expected.stranded -= before.get(x, y) && !before.in_square(x, y, 2);
            }
        stranded_anywhere += expected.stranded;
        const FrameView frame{columns, rows, mask.data(), rim.data(), side.data()};
        for (const Kernels* set : sets()) {
            std::vector<std::uint64_t> scratch(3 * std::size_t{columns + 2} * rows);
            for (std::uint64_t& word : scratch) word = random_word(random);
            const FrameRating rating = set->rate(frame, page.data(), stride, shift, scratch.data());
            ASSERT_EQ(rating.stranded, expected.stranded) << n;
            ASSERT_EQ(rating.open, expected.open) << n;
        }
    }
    EXPECT_GT(stranded_anywhere, 1000);
}

TEST(Kernels, FirstDisjointIsTheFirst) {
    test::Random random(12);
    int found = 0, none = 0;
    for (int n = 0; n < 2000; ++n) {
        const std::size_t size = 1 + random.bits() % 70, begin = random.bits() % size;
        std::vector<std::uint64_t> a((size + 15) / 16 * 16), b(a.size());
        // So few bits that some pairs meet none; the padding would always be disjoint.
        const std::uint64_t not_in_a = random_word(random) & random_word(random) & random_word(random);
        const std::uint64_t not_in_b = random_word(random) & random_word(random) & random_word(random);
        for (std::size_t i = 0; i < size; ++i) {
            a[i] = std::uint64_t{1} << random.bits() % 64 | std::uint64_t{1} << random.bits() % 64;
            b[i] = random.bits() % 2 == 0 ? not_in_b : std::uint64_t{1} << random.bits() % 64;
            if (n % 3 == 0) b[i] |= not_in_b;
        }
        std::size_t expected = begin;
        while (expected < size && ((a[expected] & not_in_a) != 0 || (b[expected] & not_in_b) != 0)) ++expected;
        ++(expected < size ? found : none);
        for (const Kernels* set : sets())
            ASSERT_EQ(set->first_disjoint(a.data(), b.data(), begin, size, not_in_a, not_in_b), expected) << n;
    }
    EXPECT_GT(found, 500);
    EXPECT_GT(none, 500);
}

// Away from the window's edge: one texel for squares of 2, two for those of 3.
TEST(Kernels, StrandedCountsTexelsOutsideOfSquares) {
    test::Random random(13);
    for (int n = 0; n < 300; ++n) {
        TinyWindow window{};
        Texels texels(32, kTinyRows);
        for (std::uint32_t r = 0; r < kTinyRows; ++r) {
            window[r] = random.bits() | random.bits();
            if (n % 2 == 0) window[r] |= random.bits();
            for (std::uint32_t x = 0; x < 32; ++x) texels.set[r * 32 + x] = window[r] >> x & 1;
        }
        std::int32_t expected = 0;
        const std::int32_t rows = kTinyRows;
        for (std::int32_t y = 0; y < rows; ++y)
            for (std::int32_t x = 0; x < 32; ++x) {
                const auto inside = [&](std::int32_t edge) {
                    return x >= edge && y >= edge && x < 32 - edge && y < rows - edge;
                };
                if (!texels.get(x, y)) continue;
                if (inside(1) && !texels.in_square(x, y, 2)) expected += 2;
                if (inside(2) && !texels.in_square(x, y, 3)) expected += 1;
            }
        ASSERT_GT(expected, 0);
        for (const Kernels* set : sets()) ASSERT_EQ(set->stranded(window), expected) << n;
    }
}

}  // namespace
}  // namespace lumel
