// The picture of who owns which texel.
#include <gtest/gtest.h>

#include <algorithm>

#include "chart/chart_picture.h"
#include "support/chart_layouts.h"

namespace lumel {
namespace {

using test::judge;
using test::layout;
using test::Layout;
using test::Level;
using test::mixed_level;

TEST(ChartPicture, OwnersAreThoseOfTheMasks) {
    const Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    const std::vector<std::uint32_t> ids = chart_ids(level.scene, l.charts, l.atlas, 0);
    const auto owned =
        static_cast<std::uint64_t>(std::count_if(ids.begin(), ids.end(), [](std::uint32_t id) { return id != kNone; }));
    // The checker leaves out what rounding may touch, a thousandth of a texel.
    const auto expected = static_cast<double>(judge(level, l).texels);
    EXPECT_NEAR(static_cast<double>(owned), expected, 1e-3 * expected);
    const auto rgb = color_ids(ids);
    for (std::size_t i = 0; i < ids.size(); ++i)
        EXPECT_EQ(ids[i] == kNone, rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2] == 0) << i;
}

}  // namespace
}  // namespace lumel
