// What two charts of a layout share under a filter, by brute force.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "chart/chart_mask.h"
#include "support/chart_checker.h"
#include "support/chart_layouts.h"

namespace lumel::test {

// Texels of all mips, or blocks of 4 x 4 texels, that lookups of two charts touch: by the corners that the atlas gives,
// and the definition of the filter.
inline std::uint64_t shared_cells(const Level& level, const Layout& l, const MaskRule& rule) {
    constexpr double kSlack = 0x1p-10;  // of a texel: rounding of placed UVs
    std::uint64_t shared = 0;
    for (std::uint32_t mip = 0; mip <= rule.mips; ++mip) {
        const double side = std::exp2(mip);
        const std::uint32_t per_block = mip == 0 ? rule.block : 1;
        std::vector<std::vector<std::uint32_t>> owner;
        for (const AtlasPage& page : l.atlas.pages) owner.emplace_back(std::size_t{page.width} * page.height, kNone);
        for (std::uint32_t w = 0; w < level.geometry.triangle_count(); ++w) {
            const Atlas::TriangleUv uv = l.atlas.triangle_uv(l.charts, level.geometry, level.scene, w);
            if (uv.page == kNone) continue;
            const AtlasPage& page = l.atlas.pages[uv.page];
            const WorldTriangle& triangle = level.geometry.triangles[w];
            const MeshCharts& mesh = l.charts.meshes[level.scene.instances[triangle.instance].mesh];
            const std::uint32_t chart =
                l.atlas.first_placement[triangle.instance] + mesh.chart_of_triangle[triangle.mesh_triangle];
            detail::Corners t;
            double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
            for (std::size_t k = 0; k < 3; ++k) {
                t[k] = {uv.texels[k].x / side, uv.texels[k].y / side};
                x0 = std::min(x0, t[k].x), x1 = std::max(x1, t[k].x);
                y0 = std::min(y0, t[k].y), y1 = std::max(y1, t[k].y);
            }
            for (double y = std::floor(y0) - 3.0; y < y1 + 3.0; ++y)
                for (double x = std::floor(x0) - 3.0; x < x1 + 3.0; ++x) {
                    if (!detail::meets_square(t, {x + 0.5, y + 0.5}, rule.reach() - kSlack)) continue;
                    if (x < 0 || y < 0 || x * side >= page.width || y * side >= page.height) {
                        ++shared;  // with what is beyond the page
                        continue;
                    }
                    const auto bx = static_cast<std::uint32_t>(x) / per_block,
                               by = static_cast<std::uint32_t>(y) / per_block;
                    std::uint32_t& o = owner[uv.page][std::size_t{by} * page.width + bx];
                    shared += o != kNone && o != chart;
                    o = chart;
                }
        }
    }
    return shared;
}

}  // namespace lumel::test
