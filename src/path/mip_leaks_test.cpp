#include "path/mip_leaks.h"

#include <gtest/gtest.h>

#include "support/traced_scene.h"

namespace lumel {
namespace {

// A floor, and across it at x = 2 a wall that faces +x; both sides of it where asked.
Scene walled_floor(bool both_sides) {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f}, {}, both_sides);
    b.object("floor", grey, [](Mesh& m) { test::add_quad(m, {0, 0, 4}, {4, 0, 0}, {0, 0, -4}); });
    b.object("wall", grey, [](Mesh& m) { test::add_quad(m, {2, 0, 0}, {0, 2, 0}, {0, 0, 4}); });
    return b.build();
}

// A row of texels of 0.25 m along x.
TexelBuffer row() {
    TexelBuffer out;
    for (std::uint16_t x = 0; x < 16; ++x) {
        out.x.push_back(x);
        out.y.push_back(0);
        out.position.push_back({0.25f * (static_cast<float>(x) + 0.5f), 0, 2});
        out.normal.push_back({0, 1, 0});
        out.world_size.push_back(0.25f);
    }
    return out;
}

TEST(MipLeaks, AreBehindTheWallByHalfATexelOfTheMip) {
    Context context(1);
    const test::TracedScene traced(walled_floor(false), context);
    const auto leaks_at = [&](std::uint32_t mip) {
        const auto leaks = find_mip_leaks(row(), traced.transport, mip, context);
        EXPECT_TRUE(leaks.ok());
        std::string out;
        for (const std::uint8_t leak : *leaks) out += leak ? '1' : '0';
        return out;
    };
    // The wall stands between texels 7 and 8. Texels of mip 2 are 1 m wide: texels 6 and 7 lie within 0.5 m of it.
    EXPECT_EQ(leaks_at(2), "0000001100000000");
    EXPECT_EQ(leaks_at(3), "0000111100000000");
}

TEST(MipLeaks, SurfacesOfTwoSidesHaveNoBack) {
    Context context(1);
    const test::TracedScene traced(walled_floor(true), context);
    const auto leaks = find_mip_leaks(row(), traced.transport, 3, context);
    ASSERT_TRUE(leaks.ok());
    EXPECT_EQ(*leaks, std::vector<std::uint8_t>(16, 0));
}

TEST(MipLeaks, SameBitsForAnyNumberOfThreads) {
    Context one(1), eight(8);
    const test::TracedScene traced(walled_floor(false), one);
    EXPECT_EQ(*find_mip_leaks(row(), traced.transport, 2, one), *find_mip_leaks(row(), traced.transport, 2, eight));
}

}  // namespace
}  // namespace lumel
