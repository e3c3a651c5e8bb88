#include "pack/mask.h"

#include <gtest/gtest.h>

#include <set>

#include "support/pack_checker.h"
#include "support/random_masks.h"

namespace lumel {
namespace {

// Every texel where the checker's own arithmetic puts it, and none more.
TEST(Mask, OrientationsMoveTexelsAsDocumented) {
    for (const ChartMask& mask : test::random_masks(40, 150, 3))
        for (std::uint8_t o = 0; o < kOrientations; ++o) {
            const ChartMask turned = oriented(mask, o);
            EXPECT_EQ(turned.count(), mask.used);
            EXPECT_EQ(turned.used, mask.used);
            for (std::uint32_t y = 0; y < mask.height; ++y)
                for (std::uint32_t x = 0; x < mask.width; ++x) {
                    std::uint32_t a = x, b = y;
                    test::turn(mask, o, a, b);
                    ASSERT_EQ(turned.get(a, b), mask.get(x, y)) << int{o};
                }
        }
}

// An L has no symmetry: eight different pictures.
TEST(Mask, AnLHasEightOrientations) {
    ChartMask mask(3, 2);
    mask.set_span(0, 0, 3);
    mask.set_span(1, 0, 1);
    std::set<std::pair<std::uint32_t, std::vector<std::uint64_t>>> seen;
    for (std::uint8_t o = 0; o < kOrientations; ++o) {
        const ChartMask turned = oriented(mask, o);
        seen.insert({turned.width, turned.bits});
    }
    EXPECT_EQ(seen.size(), 8u);
}

}  // namespace
}  // namespace lumel
