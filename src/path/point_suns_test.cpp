// Suns without size, whose shadow ray is traced once for each point of a texel where that says all.
#include <gtest/gtest.h>

#include <cmath>

#include "math/constants.h"
#include "support/charted_scene.h"
#include "support/statistics.h"

namespace lumel {
namespace {

constexpr std::uint32_t kSamples = 512;

// A floor under a sun without size; above a part of it a sheet that lets `1 - alpha` of the rays through.
Scene floor_under_a_sheet(AlphaMode mode, float alpha) {
    test::SceneBuilder b;
    const auto white = b.material({0.5f, 0.5f, 0.5f});
    const auto sheet = b.material({0, 0, 0}, {}, true);
    b.scene().materials[sheet].alpha_mode = mode;
    b.scene().materials[sheet].alpha = alpha;
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 4}, {4, 0, 0}, {0, 0, -4}); });
    const auto above = b.object("sheet", sheet, [](Mesh& m) {
        test::add_quad(m, {-8, 1, 10}, {10, 0, 0}, {0, 0, -20});
    });
    b.scene().instances[above].node_class = NodeClass::occluder;
    Light& sun = b.light(LightShape::sun);
    sun.direction = {0, -1, 0};
    sun.intensity = {3, 3, 3};
    return b.build();
}

RadianceSums gather_floor(const test::ChartedScene& floor) {
    PathOptions path;
    path.samples = kSamples;
    path.bounces = 0;
    return floor.gather(path);
}

// Texels whose points are all below the sheet, and all beside it.
template <class Check>
void for_texels(const test::ChartedScene& floor, bool below, Check&& check) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < floor.texels.size(); ++i) {
        const float x = floor.texels.position[i].x, reach = floor.texels.world_size[i];
        if (below ? x > 2 - reach : x < 2 + reach) continue;
        check(i);
        ++seen;
    }
    EXPECT_GT(seen, 100u);
}

// What a surface lets through by chance is another matter for each sample: 64 draws a texel would leave 6 % of noise
// however many samples there are.
TEST(PointSuns, ASheetThatLetsHalfThroughConvergesWithTheSamples) {
    Context context(2);
    const test::ChartedScene floor(floor_under_a_sheet(AlphaMode::blend, 0.5f), 8, context);
    const RadianceSums sums = gather_floor(floor);
    const double expected = 1.5 / static_cast<double>(kPi);  // E/pi, half of the sun
    // By draws of one half each; Sidak at 1e-4 over some 200 texels.
    const double deviation = expected / std::sqrt(double{kSamples});
    const double limit = test::z_limit(test::sidak(1e-4, floor.texels.size()));
    for_texels(floor, true,
               [&](std::size_t i) { EXPECT_NEAR(sums.layers[i][0].irradiance.x, expected, limit * deviation) << i; });
}

// Once a point or once a sample: the same light. Where a material of the scene blends, here one that no ray meets, it
// is once a sample.
TEST(PointSuns, OnceAPointIsTheSameAsOnceASample) {
    Context context(2);
    Scene scene = floor_under_a_sheet(AlphaMode::mask, 1.0f);
    const test::ChartedScene once_a_point(scene, 8, context);
    scene.materials.push_back({});
    scene.materials.back().alpha_mode = AlphaMode::blend;
    const test::ChartedScene once_a_sample(std::move(scene), 8, context);
    const RadianceSums a = gather_floor(once_a_point), b = gather_floor(once_a_sample);
    ASSERT_EQ(a.size(), b.size());
    // The same 512 numbers in another order: rounding stays below 1e-5.
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a.layers[i][0].irradiance.x, b.layers[i][0].irradiance.x, 1e-5) << i;
    for_texels(once_a_point, true, [&](std::size_t i) { EXPECT_EQ(a.layers[i][0].irradiance.x, 0.0f) << i; });
    for_texels(once_a_point, false, [&](std::size_t i) {
        EXPECT_NEAR(a.layers[i][0].irradiance.x, 3.0 / static_cast<double>(kPi), 1e-5) << i;
    });
    EXPECT_LT(once_a_point.traced.tracer->statistics().rays, once_a_sample.traced.tracer->statistics().rays);
}

}  // namespace
}  // namespace lumel
