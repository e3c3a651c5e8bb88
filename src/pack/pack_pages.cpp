#include "pack/pack_pages.h"

#include <algorithm>
#include <chrono>
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

namespace {

std::uint32_t page_width(std::span<const ChartMask> masks, const PackOptions& options) {
    if (options.width != 0) return options.width;
    const std::uint32_t width = default_width(masks);
    return options.max_page != 0 ? std::min(width, options.max_page) : width;
}

}  // namespace

std::uint64_t page_bytes(std::span<const ChartMask> masks, const PackOptions& options) {
    std::uint64_t boxes = 0, highest = 0;
    std::uint32_t level = 1;
    for (const ChartMask& mask : masks) {
        boxes += std::uint64_t{mask.width} * mask.height;
        highest = std::max(highest, std::uint64_t{mask.height});
        level = std::max(level, square_level(std::min(mask.width, mask.height)));
    }
    const std::uint32_t width = page_width(masks, options);
    std::uint64_t rows = 2 * boxes / width + highest;
    if (options.max_page != 0) rows = std::min(rows, std::uint64_t{options.max_page});
    return rows * FreeMap::row_bytes(width, level);
}

PagePacking pack_pages(std::span<const ChartMask> masks, const PackOptions& options, Context& context) {
    PagePacking out;
    out.width = page_width(masks, options);
    out.charts.resize(masks.size());
    FillOptions fill;
    fill.width = out.width;
    fill.height = options.max_page;
    fill.orientations = options.orientations;
    std::vector<std::uint32_t> left(masks.size());
    std::iota(left.begin(), left.end(), 0u);
    auto last_report = std::chrono::steady_clock::now();
    fill.on_placed = [&](std::size_t placed) {
        const auto now = std::chrono::steady_clock::now();
        if (now - last_report <= std::chrono::milliseconds(100)) return;
        last_report = now;
        placed += masks.size() - left.size();
        context.report("pack", static_cast<double>(placed) / static_cast<double>(masks.size()));
    };
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
        fill.on_placed(0);
    }
    context.report("pack", 1.0);
    out.complete = true;
    return out;
}

}  // namespace lumel
