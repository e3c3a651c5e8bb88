// Where texels start, told without tracing them, is where the bake starts them.
#include "path/texel_starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/charted_scene.h"

namespace lumel {
namespace {

void add_wall(test::SceneBuilder& b, std::uint32_t material) {
    b.object(
        "wall", material,
        [](Mesh& m) {
            test::add_quad(m, {0.01f, -1, 3}, {0, 0, -6}, {0, 3, 0});
        },
        {}, NodeClass::volume);
}

// A floor of 4 x 4 m with a thin double-sided wall on it, which stands in the middle of a row of texels: 8 texels a
// metre with centres at multiples of 0.125 m, which gather from 0.03 m around these; the wall is 0.01 m beside one row.
Scene floor_with_wall() {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f}), sheet = b.material({0.5f, 0.5f, 0.5f}, {}, true);
    b.object("floor", grey, [](Mesh& m) { test::add_quad(m, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}); });
    add_wall(b, sheet);
    b.scene().sky.color = {1, 1, 1};
    return b.build();
}

TexelStarts starts_of(const test::ChartedScene& charted, const PathOptions& path) {
    return find_texel_starts(charted.texels, charted.charts, charted.atlas, charted.traced.transport, path,
                             charted.context)
        .value();
}

TEST(TexelStarts, AWallParsTheTexelsThatItStandsOn) {
    Context context(1);
    const test::ChartedScene charted(floor_with_wall(), 8.0, context);
    const TexelStarts starts = starts_of(charted, {});
    std::size_t parted = 0;
    for (std::size_t i = 0; i < charted.texels.size(); ++i) {
        const float beside = std::abs(charted.texels.position[i].x - 0.01f);
        const bool moved = starts.place[i] != StartsPlace::usual;
        parted += moved ? 1 : 0;
        // A texel is 0.125 m wide: from half of that on nothing of it is beyond the wall.
        if (moved) {
            EXPECT_LT(beside, 0.0626f) << charted.texels.position[i].z;
            EXPECT_EQ(starts.place[i], StartsPlace::part);
        }
        EXPECT_EQ(starts.flat_share[i], 0.0f);
    }
    EXPECT_GE(parted, 30u);  // of the 32 or 33 texels along the floor
}

TEST(TexelStarts, TexelsOfBothSidesKeepTheirPoints) {
    Context context(1);
    test::SceneBuilder b;
    const auto sheet = b.material({0.5f, 0.5f, 0.5f}, {}, true);
    b.object("floor", sheet, [](Mesh& m) { test::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}); });
    add_wall(b, sheet);
    b.scene().sky.color = {1, 1, 1};
    const test::ChartedScene charted(b.build(), 8.0, context);
    PathOptions path;
    const auto moved = [&] {
        const TexelStarts starts = starts_of(charted, path);
        return std::ranges::count_if(starts.place, [](StartsPlace p) { return p != StartsPlace::usual; });
    };
    EXPECT_GT(moved(), 0);
    path.two_sided = true;
    EXPECT_EQ(moved(), 0);
}

TEST(TexelStarts, SameBitsForAnyThreads) {
    Context one(1), three(3);
    const test::ChartedScene a(test::room(), 12.0, one), b(test::room(), 12.0, three);
    const TexelStarts first = starts_of(a, {}), second = starts_of(b, {});
    EXPECT_EQ(first.place, second.place);
    EXPECT_EQ(first.flat_share, second.flat_share);
}

}  // namespace
}  // namespace lumel
