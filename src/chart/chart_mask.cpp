#include "chart/chart_mask.h"

namespace lumel {

TexelMap fit_to_centres(Vec2 low, Vec2 high, std::uint32_t width, std::uint32_t height, double x, double y) {
    const double size_x = double{high.x} - low.x, size_y = double{high.y} - low.y;
    TexelMap map;
    map.scale_x = size_x > 0.0 ? (width - 1) / size_x : 1.0;
    map.scale_y = size_y > 0.0 ? (height - 1) / size_y : 1.0;
    map.offset_x = x + 0.5 - low.x * map.scale_x;
    map.offset_y = y + 0.5 - low.y * map.scale_y;
    return map;
}

ChartMask make_mask(std::span<const std::uint32_t> triangles, std::span<const UvTriangle> uv, Vec2 low, Vec2 high,
                    std::uint32_t width, std::uint32_t height) {
    ChartMask mask(width, height);
    const TexelMap map = fit_to_centres(low, high, width, height, 0.0, 0.0);
    const auto draw = [&](double reach) {
        for (const std::uint32_t t : triangles)
            for_each_mask_span(
                uv[t], map, width, height,
                [&](std::uint32_t y, std::uint32_t x0, std::uint32_t x1) { mask.set_span(y, x0, x1); }, reach);
        return mask.count();
    };
    mask.covered = draw(kTexelReach);  // of which all are among the others
    mask.used = draw(kLookupReach);
    return mask;
}

}  // namespace lumel
