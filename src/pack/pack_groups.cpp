#include "pack/pack_groups.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"

namespace lumel {
namespace {

// Of the side of a square that its charts would fill: what is tried. An atlas of a few charts is dense at some widths
// and not at others, by how the largest lie side by side.
constexpr std::array<double, 8> kWidths{1.02, 1.0, 1.04, 1.07, 1.1, 1.15, 0.96, 0.9};
constexpr std::array<double, 8> kMoreWidths{1.08, 1.12, 1.18, 1.22, 1.26, 1.3, 0.86, 0.82};  // where these are poor
constexpr double kPoor = 0.92;

std::uint32_t rounded_up(std::uint32_t edge, std::uint32_t multiple) {
    return (edge + multiple - 1) / multiple * multiple;
}

class GroupPacker {
public:
    GroupPacker(std::span<const ChartMask> masks, const GroupOptions& options, Context& context)
        : masks_(masks), options_(options), context_(context) {}

    // The best of some widths. Without size: none holds all of the charts.
    GroupPage pack(const std::vector<std::uint32_t>& charts) {
        GroupPage best;
        std::uint32_t widest = 1;
        std::uint64_t used = 0;
        for (const std::uint32_t c : charts) {
            widest = std::max(widest, masks_[c].width);
            used += masks_[c].used;
        }
        const double side = std::sqrt(static_cast<double>(used));
        const std::uint32_t largest = options_.max_page != 0 ? options_.max_page : FreeMap::kMaxWidth;
        const std::uint32_t most = largest / options_.multiple * options_.multiple;
        std::vector<std::uint32_t> tried;
        std::vector<double> factors(kWidths.begin(), kWidths.end());
        factors.insert(factors.end(), kMoreWidths.begin(), kMoreWidths.end());
        for (std::size_t k = 0; k < factors.size(); ++k) {
            if (k == kWidths.size() && static_cast<double>(used) >= kPoor * static_cast<double>(best.area()) &&
                best.width != 0)
                break;
            const double factor = factors[k];
            const auto wanted = std::max(static_cast<std::uint32_t>(std::ceil(factor * side)), widest);
            const std::uint32_t width = std::min(rounded_up(wanted, options_.multiple), most);
            if (std::ranges::find(tried, width) != tried.end()) continue;
            tried.push_back(width);
            FillOptions fill;
            fill.width = width;
            fill.height = options_.max_page != 0 ? most : 0;
            fill.orientations = options_.orientations;
            PageFill page = fill_page(masks_, charts, fill, context_);
            if (context_.cancelled()) return {};
            if (page.placed < charts.size()) continue;
            const GroupPage shape{width, rounded_up(page.height, options_.multiple), used};
            if (best.width != 0 && shape.area() >= best.area()) continue;
            best = shape;
            spots_ = std::move(page.spots);
        }
        return best;
    }
    // Of the charts of the group that was packed last.
    [[nodiscard]] const std::vector<PageSpot>& spots() const { return spots_; }

private:
    std::span<const ChartMask> masks_;
    const GroupOptions& options_;
    Context& context_;
    std::vector<PageSpot> spots_;
};

}  // namespace

GroupPacking pack_groups(std::span<const ChartMask> masks, std::span<const std::uint32_t> group_of,
                         std::uint32_t groups, const GroupOptions& options, Context& context) {
    LUMEL_CHECK(group_of.size() == masks.size(), group_of.size(), masks.size());
    LUMEL_CHECK(options.multiple > 0, options.multiple);
    std::vector<std::vector<std::uint32_t>> charts(groups);
    for (std::uint32_t c = 0; c < masks.size(); ++c) {
        LUMEL_CHECK(group_of[c] < groups, c, group_of[c]);
        charts[group_of[c]].push_back(c);
    }
    GroupPacking out;
    out.charts.resize(masks.size());
    out.groups.resize(groups);
    GroupPacker packer(masks, options, context);
    for (std::uint32_t g = 0; g < groups; ++g) {
        context.report("pack", static_cast<double>(g) / groups);
        if (charts[g].empty()) continue;
        out.groups[g] = packer.pack(charts[g]);
        if (context.cancelled()) return out;
        if (out.groups[g].width == 0) {
            out.too_large.push_back(g);
            continue;
        }
        for (std::size_t k = 0; k < charts[g].size(); ++k) {
            const PageSpot& spot = packer.spots()[k];
            out.charts[charts[g][k]] = {g, spot.x, spot.y, spot.orientation};
        }
    }
    context.report("pack", 1.0);
    out.complete = true;
    return out;
}

}  // namespace lumel
