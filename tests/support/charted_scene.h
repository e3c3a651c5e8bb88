// A scene built in code with charts of its own on one page, ready to gather.
#pragma once

#include <gtest/gtest.h>

#include "path/gather_page.h"
#include "support/traced_scene.h"
#include "texel/texel_buffer.h"

namespace lumel::test {

struct ChartedScene {
    Context& context;
    TracedScene traced;
    ChartSet charts;
    Atlas atlas;
    TexelBuffer texels;

    ChartedScene(Scene scene, double texels_per_metre, Context& with) : context(with), traced(std::move(scene), with) {
        ChartOptions layout;
        layout.uv1 = Uv1Policy::ignore;
        layout.texels_per_metre = texels_per_metre;
        charts = make_charts(traced.scene, traced.geometry, layout, context).value();
        atlas = make_atlas(traced.scene, traced.geometry, charts, layout, context).value();
        EXPECT_EQ(atlas.pages.size(), 1u);
        const auto triangles = triangles_by_page(traced.scene, traced.geometry, charts, atlas);
        texels = rasterize_page(traced.scene, traced.geometry, charts, atlas, 0, triangles[0], context).value();
    }

    [[nodiscard]] RadianceSums gather(const PathOptions& path, const SurfaceCells* cells = nullptr) const {
        Transport transport = traced.transport;
        transport.cells = cells;
        return gather_page(texels, charts, atlas, transport, path, 0, texels.size(), context).value();
    }
};

// Irradiance of a texel, all layers.
inline Vec3 total_irradiance(const RadianceSums& sums, std::size_t texel) {
    Vec3 sum{};
    for (const LayerMoments& layer : sums.layers[texel]) sum += layer.irradiance;
    return sum;
}

}  // namespace lumel::test
