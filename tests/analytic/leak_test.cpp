// Two rooms over one floor, one of them with a lamp: nothing of it reaches the other in a whole bake, by cells or by
// brute force, as sampled or denoised.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "lumel/bake.h"
#include "post/lightmap.h"
#include "support/scene_builder.h"
#include "texel/texel_buffer.h"

namespace lumel {
namespace {

constexpr float kWallAt = 2.03f, kTexel = 0.125f;

struct Wall {
    const char* name;
    float thickness;  // 0: one double-sided quad
};

Scene two_rooms(float thickness) {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f}), sheet = b.material({0.8f, 0.8f, 0.8f}, {}, true);
    const auto lamp = b.material({0, 0, 0}, {20, 20, 20});
    b.object("rooms", white, [](Mesh& m) { test::add_box(m, {0, 0, 0}, {4, 2, 2}, true); });
    b.object("wall", thickness > 0.0f ? white : sheet, [&](Mesh& m) {
        if (thickness > 0.0f)
            test::add_box(m, {kWallAt - 0.5f * thickness, 0, 0}, {kWallAt + 0.5f * thickness, 2, 2}, false);
        else
            test::add_quad(m, {kWallAt, 0, 0}, {0, 2, 0}, {0, 0, 2});
    });
    b.object("lamp", lamp, [](Mesh& m) { test::add_quad(m, {0.5f, 1.9f, 0.5f}, {1, 0, 0}, {0, 0, 1}); });
    return b.build();
}

// Calls visit(position, light) for each texel that was baked or filled.
template <class Visit>
void for_each_texel(const Scene& scene, const BakeOptions& options, Visit&& visit) {
    Context context;
    std::vector<TexelBuffer> pages;
    BakeSink sink;
    sink.layout = [&](const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas) {
        const auto triangles = triangles_by_page(scene, geometry, charts, atlas);
        for (std::uint32_t p = 0; p < triangles.size(); ++p)
            pages.push_back(rasterize_page(scene, geometry, charts, atlas, p, triangles[p], context).value());
        return success();
    };
    sink.page = [&](const Lightmap& map) {
        const TexelBuffer& texels = pages.at(map.page);
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (map.coverage[i] == Coverage::none) continue;
            Vec3 light{};
            for (const LayerMoments& layer : map.texels.layers[i]) light += layer.irradiance;
            visit(texels.position[i], (light.x + light.y + light.z) / 3.0f);
        }
        return success();
    };
    const Result<BakeReport> report = bake(scene, options, sink, context);
    ASSERT_TRUE(report.ok()) << report.error().text();
}

class Leak : public testing::TestWithParam<std::tuple<Wall, Integrator, bool>> {};

TEST_P(Leak, NoLightComesThroughAWall) {
    const Wall& wall = std::get<0>(GetParam());
    BakeOptions options;
    options.texels_per_metre = 1.0 / static_cast<double>(kTexel);
    options.samples = 64;
    options.integrator = std::get<1>(GetParam());
    options.denoise = std::get<2>(GetParam());
    double bright = 0.0, count = 0.0, dark = 0.0, brightest = 0.0;
    Vec3 worst{};
    for_each_texel(two_rooms(wall.thickness), options, [&](Vec3 at, float light) {
        if (at.x < kWallAt - 0.5f * wall.thickness) {
            bright += static_cast<double>(light);
            count += 1.0;
        } else if (at.x >
                   kWallAt + 0.5f * wall.thickness + kTexel) {  // texels that the wall stands on lie in both rooms
            dark += 1.0;
            if (static_cast<double>(light) <= brightest) return;
            brightest = static_cast<double>(light);
            worst = at;
        }
    });
    ASSERT_GT(count, 500.0);
    ASSERT_GT(dark, 500.0);
    ASSERT_GT(bright / count, 1.0);
    EXPECT_LE(brightest, 0.01 * bright / count) << "at " << worst.x << ' ' << worst.y << ' ' << worst.z;
}

std::string name_of(const testing::TestParamInfo<Leak::ParamType>& instance) {
    const auto& [wall, integrator, denoise] = instance.param;
    return std::string(wall.name) + (integrator == Integrator::cells ? "_cells" : "_paths") +
           (denoise ? "_denoised" : "");
}

INSTANTIATE_TEST_SUITE_P(Walls, Leak,
                         testing::Combine(testing::Values(Wall{"solid_100mm", 0.1f}, Wall{"solid_20mm", 0.02f},
                                                          Wall{"sheet", 0.0f}),
                                          testing::Values(Integrator::cells, Integrator::paths), testing::Bool()),
                         name_of);

}  // namespace
}  // namespace lumel
