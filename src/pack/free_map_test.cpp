#include "pack/free_map.h"

#include <gtest/gtest.h>

#include "pack/cover.h"
#include "pack/kernels.h"
#include "support/random_masks.h"

namespace lumel {
namespace {

using test::random_mask;

// A page as a picture.
struct Picture {
    std::uint32_t width, height;
    std::vector<std::uint8_t> taken;

    Picture(std::uint32_t w, std::uint32_t h) : width(w), height(h), taken(std::size_t{w} * h, 0) {}
    [[nodiscard]] bool free(std::uint32_t x, std::uint32_t y) const {
        return x < width && y < height && taken[std::size_t{y} * width + x] == 0;
    }
    [[nodiscard]] bool fits(const ChartMask& mask, std::uint32_t x, std::uint32_t y) const {
        for (std::uint32_t v = 0; v < mask.height; ++v)
            for (std::uint32_t u = 0; u < mask.width; ++u)
                if (mask.get(u, v) && !free(x + u, y + v)) return false;
        return true;
    }
    void take(const ChartMask& mask, std::uint32_t x, std::uint32_t y) {
        for (std::uint32_t v = 0; v < mask.height; ++v)
            for (std::uint32_t u = 0; u < mask.width; ++u)
                if (mask.get(u, v)) taken[std::size_t{y + v} * width + x + u] = 1;
    }
};

TEST(Cover, SquaresCoverTheMaskAndNothingElse) {
    for (const ChartMask& mask : test::random_masks(300, 200, 8)) {
        ChartMask drawn(mask.width, mask.height);
        for (const CoverSquare& s : cover(mask, 19)) {
            const std::uint32_t side = kSquareSides[s.level];
            ASSERT_LE(s.x + side, mask.width);
            for (std::uint32_t y = s.y; y < s.y + side; ++y) drawn.set_span(y, s.x, s.x + side);
        }
        ASSERT_TRUE(same_texels(drawn, mask));
    }
}

TEST(FreeMap, LevelsAreTheFreeSquares) {
    test::Random random(6);
    constexpr std::uint32_t kWidth = 300, kHeight = 120, kLevels = 12;
    FreeMap map(kWidth, kHeight, kLevels);
    Picture picture(kWidth, kHeight);
    for (int n = 0; n < 60; ++n) {
        const ChartMask mask = random_mask(random, 40);
        const std::uint32_t x = random.bits() % (kWidth - mask.width), y = random.bits() % (kHeight - mask.height);
        if (!picture.fits(mask, x, y)) continue;
        map.take(mask, x, y, kLevels);
        picture.take(mask, x, y);
    }
    map.reach(kHeight);
    std::uint64_t some = 0;
    for (std::uint32_t k = 0; k <= kLevels; ++k) {
        const ChartMask square = test::rectangle_mask(kSquareSides[k], kSquareSides[k]);
        for (std::uint32_t y = 0; y < kHeight; ++y) {
            bool any = false;
            for (std::uint32_t x = 0; x < kWidth; ++x) {
                const bool is_free = (map.row(k, y)[x / 64] >> (x % 64) & 1) != 0;
                ASSERT_EQ(is_free, picture.fits(square, x, y)) << k << ": " << x << " " << y;
                any |= is_free;
                some += is_free;
                if (is_free) {
                    ASSERT_TRUE(map.units(k)[y] >> (x >> map.unit_shift()) & 1);
                }
            }
            ASSERT_EQ((map.rows(k)[y / 64] >> (y % 64) & 1) != 0, any);
        }
    }
    EXPECT_GT(some, 10000u);
}

// Every position by every instruction set, against the picture; also on a page so wide that a unit is many words.
TEST(Kernels, FindAllPositions) {
    std::size_t sets = 0;
    const Kernels* const* all = all_kernels(sets);
    ASSERT_GE(sets, 1u);
    for (const std::uint32_t width : {77u, 520u, 9000u}) {
        test::Random random(width);
        const std::uint32_t height = width > 1000 ? 12 : 60, level = square_level(height);
        FreeMap map(width, height, level);
        Picture picture(width, height);
        std::uint64_t found = 0;
        for (int n = 0; n < 60; ++n) {
            const ChartMask mask = random_mask(random, height);
            const std::vector<CoverSquare> squares = cover(mask, level);
            map.reach(height);
            const std::uint32_t last_x = width - mask.width, last_y = height - mask.height;
            ChartMask expected(width, height);
            for (std::uint32_t y = 0; y <= last_y; ++y)
                for (std::uint32_t x = 0; x <= last_x; ++x)
                    if (picture.fits(mask, x, y)) expected.set(x, y);
            for (std::size_t set = 0; set < sets; ++set) {
                ChartMask positions(width, height);
                FitSearch search;
                for (; all[set]->next_fit(map, squares.data(), squares.size(), last_x, last_y, search); ++search.block)
                    for (std::uint32_t i = 0; i < FreeMap::kBlockBits; ++i)
                        if (search.fits[i / 64] >> (i % 64) & 1)
                            positions.set(search.block * FreeMap::kBlockBits + i, search.y);
                ASSERT_TRUE(same_texels(positions, expected)) << width << ": " << n << ", set " << set;
            }
            found += expected.count();
            const std::uint32_t x = random.bits() % (width - mask.width + 1);
            const std::uint32_t y = random.bits() % (height - mask.height + 1);
            if (!picture.fits(mask, x, y)) continue;
            map.take(mask, x, y, level);
            picture.take(mask, x, y);
        }
        EXPECT_GT(found, 1000u);
    }
}

}  // namespace
}  // namespace lumel
