// The texels of a chart: those that a lookup of any of its points can touch, under the filter that is declared.
//
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018): a texel belongs to a chart if the box of
// side 2 around its centre meets one of the chart's triangles; the chart's box is fitted to texel centres, so that its
// border costs no texel more.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "chart/overlap.h"
#include "lumel/options.h"
#include "pack/mask.h"

namespace lumel {

// uv_texels = uv * scale + offset, in double precision.
struct TexelMap {
    double scale_x = 1.0, scale_y = 1.0, offset_x = 0.0, offset_y = 0.0;
};

// What the runtime does with the lightmap. A cell is the smallest piece of a page that a chart has for itself: a texel
// of the lowest mip, or a block. Masks are in cells, and charts lie on whole ones.
struct MaskRule {
    using Filter = LookupFilter;
    static constexpr std::uint32_t kMaxMips = 6;

    Filter filter = Filter::bilinear;
    std::uint32_t mips =
        0;  // lookups in mips 0..this one, at most kMaxMips: their texels hold the light of one chart, too
    std::uint32_t block = 1;  // 4: no block of 4 x 4 texels of the page (mip 0) holds two charts, for BC formats

    [[nodiscard]] std::uint32_t mip_texel() const { return 1u << mips; }
    [[nodiscard]] std::uint32_t cell() const { return mip_texel() > block ? mip_texel() : block; }
    // How far a texel is from a point that reads it, at most, in texels of its mip.
    [[nodiscard]] std::uint32_t reach() const { return filter == Filter::bicubic ? 2 : 1; }
    // From the corner of a mask to the low corner of its chart, texels: the centre of the first texel of the lowest mip
    // that has as many beside it as lookups reach.
    [[nodiscard]] double inset() const { return (reach() - 0.5) * mip_texel(); }
    // Cells of a chart whose box spans the centres of so many texels (2 or more, or 1 for one that is a point).
    [[nodiscard]] std::uint32_t cells(std::uint32_t texels) const;
    // The most texels whose cells fit this length of a page; 0 where not even one does.
    [[nodiscard]] std::uint32_t texels_within(std::uint32_t length) const;

    bool operator==(const MaskRule&) const = default;
};

// Calls span(y, x0, x1) for the texels x0 .. x1 - 1 of row y that belong to the triangle, clipped to width x height.
// Open boxes: a triangle that only touches a box does not take it. Boxes reach as far from a texel's centre as a lookup
// does; half a texel is the texel itself.
inline constexpr double kLookupReach = 1.0, kTexelReach = 0.5;
template <class Span>
void for_each_mask_span(const UvTriangle& triangle, const TexelMap& map, std::uint32_t width, std::uint32_t height,
                        const Span& span, double reach = kLookupReach);

// The mask of a chart whose box spans the centres of `width` x `height` texels: steps of (width - 1) x (height - 1).
// `low` and `high` are the bounds of its UVs. Size and `used` are in cells of the rule, `covered` in texels.
ChartMask make_mask(std::span<const std::uint32_t> triangles, std::span<const UvTriangle> uv, Vec2 low, Vec2 high,
                    std::uint32_t width, std::uint32_t height, const MaskRule& rule = {});

// The map that puts `low` on the centre of texel (x, y) and `high` on that of (x + width - 1, y + height - 1).
TexelMap fit_to_centres(Vec2 low, Vec2 high, std::uint32_t width, std::uint32_t height, double x, double y);

// ---- Inline parts ---------------------------------------------------------------------------------------------------

namespace detail {

// Range of x of the part of a triangle with y in [low, high]; empty (low > high) where there is none.
struct XRange {
    double low = 1e300, high = -1e300;
    void add(double x) {
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
};

inline XRange clip_to_rows(const double (&x)[3], const double (&y)[3], double low, double high) {
    XRange range;
    for (int k = 0; k < 3; ++k) {
        const int n = k == 2 ? 0 : k + 1;
        if (y[k] >= low && y[k] <= high) range.add(x[k]);
        for (const double level : {low, high})
            if ((y[k] < level) != (y[n] < level) && y[k] != y[n])
                range.add(x[k] + (x[n] - x[k]) * ((level - y[k]) / (y[n] - y[k])));
    }
    return range;
}

}  // namespace detail

template <class Span>
void for_each_mask_span(const UvTriangle& triangle, const TexelMap& map, std::uint32_t width, std::uint32_t height,
                        const Span& span, double reach) {
    // Rounding of coordinates that lie on texel centres by construction must not reach the next texel.
    constexpr double kSnap = 1e-4;
    double x[3], y[3], y_low = 1e300, y_high = -1e300;
    for (int k = 0; k < 3; ++k) {
        x[k] = double{triangle[k].x} * map.scale_x + map.offset_x;
        y[k] = double{triangle[k].y} * map.scale_y + map.offset_y;
        y_low = y[k] < y_low ? y[k] : y_low;
        y_high = y[k] > y_high ? y[k] : y_high;
    }
    // Texel j takes part where j + 0.5 lies in the open interval (low - reach, high + reach).
    const auto first = [reach](double low, std::uint32_t size) {
        const double j = std::floor(low - reach - 0.5 + kSnap) + 1.0;
        return static_cast<std::uint32_t>(j < 0.0 ? 0.0 : (j > size ? size : j));
    };
    const auto end = [reach](double high, std::uint32_t size) {
        const double j = std::ceil(high + reach - 0.5 - kSnap);
        return static_cast<std::uint32_t>(j < 0.0 ? 0.0 : (j > size ? size : j));
    };
    const std::uint32_t row_end = end(y_high, height);
    for (std::uint32_t row = first(y_low, height); row < row_end; ++row) {
        const detail::XRange range = detail::clip_to_rows(x, y, row + 0.5 - reach, row + 0.5 + reach);
        if (range.low > range.high) continue;
        const std::uint32_t x0 = first(range.low, width), x1 = end(range.high, width);
        if (x0 < x1) span(row, x0, x1);
    }
}

}  // namespace lumel
