#include "pack/sweep.h"

#include <gtest/gtest.h>

#include "support/random_masks.h"

namespace lumel {
namespace {

using test::random_mask;

TEST(PageBits, FindsTheFirstPlaceByRows) {
    test::Random random(5);
    PageBits page(150);
    std::vector<std::uint8_t> taken(150 * 400, 0);
    int placed = 0;
    for (int n = 0; n < 200; ++n) {
        const ChartMask mask = random_mask(random, 80);
        const auto free_at = [&](std::uint32_t x, std::uint32_t y) {
            for (std::uint32_t v = 0; v < mask.height; ++v)
                for (std::uint32_t u = 0; u < mask.width; ++u)
                    if (mask.get(u, v) && taken[(y + v) * 150 + x + u]) return false;
            return true;
        };
        const PageBits::Spot spot = page.find(mask, 0, 400);
        bool expected = false;
        for (std::uint32_t y = 0; y + mask.height <= 400 && !expected; ++y)
            for (std::uint32_t x = 0; x + mask.width <= 150 && !expected; ++x)
                if (free_at(x, y)) {
                    expected = true;
                    ASSERT_TRUE(spot.found);
                    ASSERT_EQ(spot.x, x);
                    ASSERT_EQ(spot.y, y);
                }
        ASSERT_EQ(spot.found, expected);
        if (!expected) continue;
        page.set(mask, spot.x, spot.y);
        for (std::uint32_t v = 0; v < mask.height; ++v)
            for (std::uint32_t u = 0; u < mask.width; ++u)
                if (mask.get(u, v)) taken[(spot.y + v) * 150 + spot.x + u] = 1;
        ++placed;
    }
    EXPECT_GT(placed, 100);
}

}  // namespace
}  // namespace lumel
