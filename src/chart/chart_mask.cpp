#include "chart/chart_mask.h"

#include <utility>

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

std::uint32_t MaskRule::cells(std::uint32_t texels) const {
    const std::uint32_t mip_texels = (texels - 1 + mip_texel() - 1) / mip_texel() + 1 + 2 * (reach() - 1);
    const std::uint32_t per_cell = cell() / mip_texel();
    return (mip_texels + per_cell - 1) / per_cell;
}

std::uint32_t MaskRule::texels_within(std::uint32_t length) const {
    const std::uint32_t mip_texels = length / cell() * (cell() / mip_texel()), around = 2 * (reach() - 1);
    return mip_texels <= around ? 0 : (mip_texels - around - 1) * mip_texel() + 1;
}

namespace {

// Sets the texels that triangles reach; returns how many are set now.
std::uint64_t draw(ChartMask& mask, std::span<const std::uint32_t> triangles, std::span<const UvTriangle> uv,
                   const TexelMap& map, double reach) {
    for (const std::uint32_t t : triangles)
        for_each_mask_span(
            uv[t], map, mask.width, mask.height,
            [&](std::uint32_t y, std::uint32_t x0, std::uint32_t x1) { mask.set_span(y, x0, x1); }, reach);
    return mask.count();
}

// Cells of `factor` x `factor` texels that hold some texel of the mask.
ChartMask in_cells(const ChartMask& mask, std::uint32_t factor) {
    ChartMask out((mask.width + factor - 1) / factor, (mask.height + factor - 1) / factor);
    for (std::uint32_t y = 0; y < mask.height; ++y)
        for (std::uint32_t x = 0; x < mask.width; ++x)
            if (mask.get(x, y)) out.set(x / factor, y / factor);
    out.used = out.count();
    return out;
}

}  // namespace

ChartMask make_mask(std::span<const std::uint32_t> triangles, std::span<const UvTriangle> uv, Vec2 low, Vec2 high,
                    std::uint32_t width, std::uint32_t height, const MaskRule& rule) {
    ChartMask texels(width, height);
    TexelMap map = fit_to_centres(low, high, width, height, 0.0, 0.0);
    texels.covered = draw(texels, triangles, uv, map, kTexelReach);
    if (rule == MaskRule{}) {
        texels.used = draw(texels, triangles, uv, map, kLookupReach);  // the others are among them
        return texels;
    }
    // The same in texels of the lowest mip, whose lookups reach what those of the others do.
    const double scale = 1.0 / rule.mip_texel();
    map = fit_to_centres(low, high, width, height, rule.inset() - 0.5, rule.inset() - 0.5);
    map = {map.scale_x * scale, map.scale_y * scale, map.offset_x * scale, map.offset_y * scale};
    const std::uint32_t per_cell = rule.cell() / rule.mip_texel();
    ChartMask touched(rule.cells(width) * per_cell, rule.cells(height) * per_cell);
    touched.used = draw(touched, triangles, uv, map, rule.reach());
    ChartMask out = per_cell == 1 ? std::move(touched) : in_cells(touched, per_cell);
    out.covered = texels.covered;
    return out;
}

}  // namespace lumel
