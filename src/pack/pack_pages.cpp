#include "pack/pack_pages.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"

namespace lumel {

std::uint32_t default_width(std::span<const ChartMask> masks) {
    constexpr double kAimedAt = 0.98;
    double used = 0.0;
    std::uint32_t widest = 1;
    for (const ChartMask& mask : masks) {
        used += static_cast<double>(mask.used);
        widest = std::max(widest, mask.width);
    }
    const double square = std::min(std::ceil(std::sqrt(used / kAimedAt)), double{FreeMap::kMaxWidth});
    return std::max(widest, static_cast<std::uint32_t>(square));
}

PagePacking pack_pages(std::span<const ChartMask> masks, const PackOptions& options, Context& context) {
    PagePacking out;
    out.width = options.width != 0 ? options.width : default_width(masks);
    if (options.width == 0 && options.max_page != 0) out.width = std::min(out.width, options.max_page);
    out.charts.resize(masks.size());
    FillOptions fill;
    fill.width = out.width;
    fill.height = options.max_page;
    fill.orientations = options.orientations;
    std::vector<std::uint32_t> left(masks.size());
    std::iota(left.begin(), left.end(), 0u);
    while (!left.empty()) {
        const PageFill page = fill_page(masks, left, fill, context);
        if (context.cancelled()) return out;
        LUMEL_CHECK(page.placed > 0, left.size(), out.width);
        const auto index = static_cast<std::uint32_t>(out.pages.size());
        std::vector<std::uint32_t> later;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const PageSpot& spot = page.spots[i];
            if (spot.placed)
                out.charts[left[i]] = {index, spot.x, spot.y, spot.orientation};
            else
                later.push_back(left[i]);
        }
        out.pages.push_back({page.height, page.used});
        left = std::move(later);
    }
    out.complete = true;
    return out;
}

}  // namespace lumel
