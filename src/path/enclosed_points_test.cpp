#include "path/enclosed_points.h"

#include <gtest/gtest.h>

#include <array>

#include "lumel/bake.h"
#include "post/lightmap.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

// A box of double-sided faces without a bottom, 0.4 m wide, on a floor, and points of the floor along a line through
// its side at x = 0.
Scene box_on_floor(bool double_sided) {
    test::SceneBuilder b;
    const auto floor = b.material({0.5f, 0.5f, 0.5f}, {}, double_sided);
    b.object("floor", floor, [](Mesh& m) { test::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}); });
    b.object("box", floor, [](Mesh& m) {
        test::add_box(m, {-0.4f, 0, -0.2f}, {0, 0.4f, 0.2f}, false);
        // The bottom is the third face that add_box makes along y.
        m.triangles.erase(m.triangles.begin() + 8, m.triangles.begin() + 10);
    });
    b.scene().sky.color = {1, 1, 1};
    return b.build();
}

std::uint64_t enclosed_along(const test::TracedScene& traced, float reach) {
    std::array<SurfaceStart, 16> starts;
    for (std::size_t i = 0; i < starts.size(); ++i)  // x = -0.15, -0.13 .. 0.15
        starts[i] = {{-0.15f + 0.02f * static_cast<float>(i), 1e-4f, 0.01f}, {0, 1, 0}, kNone};
    std::array<Ray, 16> rays;
    std::array<Hit, 16> hits;
    return enclosed_points(starts, reach, 7, *traced.tracer, traced.geometry, rays, hits);
}

TEST(EnclosedPoints, AreThoseUnderWhatStandsOnTheFloor) {
    Context context(1);
    const test::TracedScene both_sides(box_on_floor(true), context);
    EXPECT_EQ(enclosed_along(both_sides, 0.6f), 0x00ffu);
    // Backs of single-sided surfaces tell by themselves: a rule of its own.
    const test::TracedScene single(box_on_floor(false), context);
    EXPECT_EQ(enclosed_along(single, 0.6f), 0u);
}

// Inside a closed shed without a lamp the floor is dark at any density, though daylight is a texel away.
TEST(EnclosedPoints, ADarkShedStaysDark) {
    test::SceneBuilder b;
    const auto white = b.material({0.5f, 0.5f, 0.5f}, {}, true);
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}); });
    b.object("shed", white, [](Mesh& m) { test::add_box(m, {-1, 0, -1}, {1, 1.2f, 1}, false); });
    b.scene().sky.color = {1, 1, 1};
    const Scene scene = b.build();
    for (const double density : {2.5, 8.0}) {
        BakeOptions options;
        options.texels_per_metre = density;
        options.samples = 32;
        double dark = 0;
        BakeSink sink;
        sink.layout = [](const WorldGeometry&, const ChartSet&, const Atlas&) { return success(); };
        sink.page = [&](const Lightmap& map) {
            for (const auto& layers : map.texels.layers) {
                Vec3 sum{};
                for (const LayerMoments& layer : layers) sum += layer.irradiance;
                dark += sum == Vec3{} ? 1 : 0;
            }
            return success();
        };
        Context context;
        ASSERT_TRUE(bake(scene, options, sink, context).ok());
        const double inside = 2.0 * density - 2.0;  // texels along an edge that lie wholly in the shed
        EXPECT_GE(dark, inside * inside) << density;
    }
}

// In a room whose walls face outwards every point sees back faces alone: what is far does not enclose.
TEST(EnclosedPoints, FarBackFacesDoNotEnclose) {
    Context context(1);
    const test::TracedScene traced(box_on_floor(true), context);
    EXPECT_EQ(enclosed_along(traced, 0.1f), 0u);
}

// Texels of 0.4 m, half of one under the box: the part that is seen has the light of the open floor, as it has where
// the box is single-sided and its backs are black.
TEST(EnclosedPoints, LeaveTheLightOfATexelToItsOpenPart) {
    std::array<std::vector<float>, 2> irradiance;
    for (const bool double_sided : {false, true}) {
        Scene scene = box_on_floor(double_sided);
        BakeOptions options;
        options.texels_per_metre = 2.5;
        options.samples = 256;
        BakeSink sink;
        sink.layout = [](const WorldGeometry&, const ChartSet&, const Atlas&) { return success(); };
        sink.page = [&](const Lightmap& map) {
            for (std::size_t i = 0; i < map.texels.size(); ++i) {
                float sum = 0;
                for (const LayerMoments& layer : map.texels.layers[i]) sum += layer.irradiance.x;
                irradiance[double_sided].push_back(map.coverage[i] == Coverage::baked ? sum : -1.0f);
            }
            return success();
        };
        Context context;
        ASSERT_TRUE(bake(scene, options, sink, context).ok());
    }
    ASSERT_EQ(irradiance[0].size(), irradiance[1].size()) << "the layouts differ";
    std::size_t both = 0;
    for (std::size_t i = 0; i < irradiance[0].size(); ++i) {
        // Texels all of which are inside the box are invalid by the backs they see if it is single-sided.
        if (irradiance[0][i] < 0.0f) continue;
        ++both;
        EXPECT_NEAR(irradiance[0][i], irradiance[1][i], 0.05f) << i;  // 256 paths: noise below 0.015
    }
    EXPECT_GT(both, 20u);
}

}  // namespace
}  // namespace lumel
