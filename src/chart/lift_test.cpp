// The displayed meshes have the texels of the baked ones.
#include <gtest/gtest.h>

#include <memory>

#include "chart/lift.h"
#include "support/chart_layouts.h"

namespace lumel {
namespace {

using test::layout;
using test::Layout;
using test::Level;
using test::mixed_level;

TEST(Lift, IsTheIdentityCornerByCorner) {
    const Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    for (std::uint32_t i = 0; i < level.scene.instances.size(); ++i) {
        const auto lifted = lift(level.scene, l.charts, l.atlas, i);
        if (level.scene.instances[i].node_class != NodeClass::lightmap) {
            EXPECT_TRUE(lifted.empty());
            continue;
        }
        const std::uint32_t first = level.geometry.first_triangle[i];
        ASSERT_EQ(lifted.size(), level.geometry.first_triangle[i + 1] - first);
        for (std::uint32_t t = 0; t < lifted.size(); ++t) {
            const auto baked = l.atlas.triangle_uv(l.charts, level.geometry, level.scene, first + t);
            EXPECT_EQ(lifted[t].page, baked.page);
            EXPECT_EQ(lifted[t].texels, baked.texels);
        }
    }
}

TEST(LiftDeathTest, RefusesAnotherMesh) {
    Level level = mixed_level();
    Context context(1);
    const Layout l = layout(level, {}, context);
    level.scene.display.meshes[0] = std::make_shared<const Mesh>(*level.scene.display.meshes[0]);  // equal is not same
    EXPECT_DEATH(lift(level.scene, l.charts, l.atlas, 0), "displayed mesh");
}

}  // namespace
}  // namespace lumel
