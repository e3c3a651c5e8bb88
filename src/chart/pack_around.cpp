#include "chart/pack_around.h"

#include <algorithm>

#include "base/check.h"
#include "lumel/scene.h"
#include "pack/fill_page.h"

namespace lumel {
namespace {

class Packer {
public:
    Packer(std::span<const ChartMask> masks, std::span<const PackItem> items, std::span<const PackSpot> kept,
           std::span<const PackPage> pages, Context& context)
        : masks_(masks), items_(items), context_(context), fixed_(pages.size()) {
        result_.spots.assign(kept.begin(), kept.end());
        result_.pages.assign(pages.begin(), pages.end());
        for (PackPage& page : result_.pages) page.used = 0;
        for (std::uint32_t i = 0; i < items.size(); ++i) {
            if (kept[i].page == kNone) {
                waiting_.push_back(i);
                continue;
            }
            result_.pages[kept[i].page].used += masks[items[i].mask].used;
            fixed_[kept[i].page].push_back({items[i].mask, kept[i].x, kept[i].y});
        }
    }

    Packing run(std::uint32_t max_page) && {
        for (std::uint32_t p = 0; p < result_.pages.size(); ++p) fill(p, result_.pages[p].height);
        if (max_page != 0) {
            for (std::uint32_t p = 0; p < result_.pages.size(); ++p)
                if (result_.pages[p].height < max_page) fill(p, max_page);  // else it was searched just now
            add_pages(max_page);
        }
        while (!result_.pages.empty() && result_.pages.back().used == 0) result_.pages.pop_back();
        result_.complete = waiting_.empty() && !context_.cancelled();
        return std::move(result_);
    }

private:
    // What waits and fits, up to this height.
    void fill(std::uint32_t p, std::uint32_t height) {
        PackPage& page = result_.pages[p];
        if (waiting_.empty() || context_.cancelled()) return;
        std::vector<std::uint32_t> tried, mask_of, left;
        for (const std::uint32_t i : waiting_) {
            const ChartMask& mask = masks_[items_[i].mask];
            const bool fits = mask.width <= page.width && mask.height <= height;
            (fits ? tried : left).push_back(i);
            if (fits) mask_of.push_back(items_[i].mask);
        }
        if (tried.empty()) return;
        FillOptions options;
        options.width = page.width;
        options.height = height;
        options.orientations = Orientations::one;
        options.fixed = fixed_[p];
        const PageFill filled = fill_page(masks_, mask_of, options, context_);
        for (std::size_t k = 0; k < tried.size(); ++k) {
            const PageSpot& spot = filled.spots[k];
            if (!spot.placed) {
                left.push_back(tried[k]);
                continue;
            }
            result_.spots[tried[k]] = {p, spot.x, spot.y};
            fixed_[p].push_back({mask_of[k], spot.x, spot.y});
            page.height = std::max(page.height, std::min((spot.y + masks_[mask_of[k]].height + 3) / 4 * 4, height));
        }
        page.used += filled.used;
        std::ranges::sort(left);
        waiting_ = std::move(left);
    }

    void add_pages(std::uint32_t max_page) {
        if (waiting_.empty() || context_.cancelled()) return;
        std::vector<PackItem> items;
        for (const std::uint32_t i : waiting_) items.push_back(items_[i]);
        const Packing more = pack(masks_, items, max_page, context_);
        if (!more.complete) return;
        const auto first = static_cast<std::uint32_t>(result_.pages.size());
        for (std::size_t k = 0; k < items.size(); ++k)
            result_.spots[waiting_[k]] = {first + more.spots[k].page, more.spots[k].x, more.spots[k].y};
        result_.pages.insert(result_.pages.end(), more.pages.begin(), more.pages.end());
        waiting_.clear();
    }

    std::span<const ChartMask> masks_;
    std::span<const PackItem> items_;
    Context& context_;
    std::vector<std::vector<FixedMask>> fixed_;  // per page
    std::vector<std::uint32_t> waiting_;         // items, ascending
    Packing result_;
};

}  // namespace

std::size_t drop_conflicts(std::span<const ChartMask> masks, std::span<const PackItem> items,
                           std::span<const PackPage> pages, std::span<PackSpot> kept) {
    std::vector<ChartMask> taken(pages.size());
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (kept[i].page == kNone) continue;
        const ChartMask& mask = masks[items[i].mask];
        const PackSpot spot = kept[i];
        const PackPage& page = pages[spot.page];
        const auto each = [&](const auto& texel) {
            for (std::uint32_t y = 0; y < mask.height; ++y)
                for (std::uint32_t x = 0; x < mask.width; ++x)
                    if (mask.get(x, y) && !texel(spot.x + x, spot.y + y)) return false;
            return true;
        };
        const bool on_page =
            std::uint64_t{spot.x} + mask.width <= page.width && std::uint64_t{spot.y} + mask.height <= page.height;
        ChartMask& bits = taken[spot.page];
        if (bits.bits.empty()) bits = ChartMask(page.width, page.height);
        if (on_page && each([&](std::uint32_t x, std::uint32_t y) { return !bits.get(x, y); })) {
            each([&](std::uint32_t x, std::uint32_t y) {
                bits.set(x, y);
                return true;
            });
            continue;
        }
        kept[i].page = kNone;
        ++dropped;
    }
    return dropped;
}

Packing pack_around(std::span<const ChartMask> masks, std::span<const PackItem> items, std::span<const PackSpot> kept,
                    std::span<const PackPage> pages, std::uint32_t max_page, Context& context) {
    LUMEL_CHECK(kept.size() == items.size(), kept.size(), items.size());
    return Packer(masks, items, kept, pages, context).run(max_page);
}

}  // namespace lumel
