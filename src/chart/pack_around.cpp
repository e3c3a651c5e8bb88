#include "chart/pack_around.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/check.h"
#include "lumel/scene.h"
#include "pack/fill_page.h"

namespace lumel {
namespace {

// A page with what lies on it, and what is to come: tried in several ways, of which one is taken.
struct Growing {
    PackPage page;
    std::vector<FixedMask> fixed;
    std::vector<std::uint32_t> waiting;  // items, ascending
    std::vector<std::pair<std::uint32_t, PackSpot>> placed;

    [[nodiscard]] std::uint64_t area() const { return std::uint64_t{page.width} * page.height; }
};

// Where a page may grow while some of what waits is placed.
enum class Side : std::uint8_t { none, rows, columns };
enum class Which : std::uint8_t { all, tall, wide };
struct Step {
    Side side;
    Which which;
};

class AroundPacker {
public:
    AroundPacker(std::span<const ChartMask> masks, std::span<const PackItem> items, std::span<const PackSpot> kept,
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
        for (std::uint32_t p = 0; p < result_.pages.size(); ++p) {
            Growing state = state_of(p);
            place({Side::none, Which::all}, p, 0, state);
            take(p, std::move(state));
        }
        if (max_page != 0 && !waiting_.empty()) {
            const std::optional<Growth> one = least_growth(max_page);
            const Packing more = one && is_little(one->added) ? Packing{} : new_pages(max_page);
            if (one && (!more.complete || one->added <= area_of(more.pages))) {
                take(one->page, Growing(one->state));
            } else if (one) {
                add_pages(more);
            } else {
                for (std::uint32_t p = 0; p < result_.pages.size(); ++p) take(p, grown(p, max_page));
                add_pages(new_pages(max_page));
            }
        }
        while (!result_.pages.empty() && result_.pages.back().used == 0) result_.pages.pop_back();
        result_.complete = waiting_.empty() && !context_.cancelled();
        return std::move(result_);
    }

private:
    [[nodiscard]] Growing state_of(std::uint32_t p) const { return {result_.pages[p], fixed_[p], waiting_, {}}; }

    void take(std::uint32_t p, Growing&& state) {
        result_.pages[p] = state.page;
        fixed_[p] = std::move(state.fixed);
        waiting_ = std::move(state.waiting);
        for (const auto& [item, spot] : state.placed) result_.spots[item] = spot;
    }

    // A page that grows until it holds all that waits.
    struct Growth {
        std::uint32_t page = 0;
        std::uint64_t added = 0;  // texels
        Growing state;
    };

    // The page that grows by the least; none where no page holds all.
    std::optional<Growth> least_growth(std::uint32_t max_page) {
        std::optional<Growth> best;
        for (std::uint32_t p = 0; p < result_.pages.size() && !context_.cancelled(); ++p) {
            Growing state = grown(p, max_page);
            const std::uint64_t added = state.area() - state_of(p).area();
            if (state.waiting.empty() && (!best || added < best->added)) best = Growth{p, added, std::move(state)};
        }
        return best;
    }

    // One more page is one more texture. It is worth that where a chart that is high and wide would have rows or
    // columns of a whole page for itself.
    [[nodiscard]] bool is_little(std::uint64_t added) const {
        constexpr double kLittle = 0.02;
        return static_cast<double>(added) <= kLittle * static_cast<double>(area_of(result_.pages));
    }

    static std::uint64_t area_of(const std::vector<PackPage>& pages) {
        std::uint64_t area = 0;
        for (const PackPage& page : pages) area += std::uint64_t{page.width} * page.height;
        return area;
    }

    // A chart that is far higher than wide costs few columns and many rows. So the page grows at either side or at
    // both, whichever leaves the least waiting and then the smallest page.
    Growing grown(std::uint32_t p, std::uint32_t max_page) {
        static const std::vector<Step> kWays[] = {
            {{Side::rows, Which::all}},
            {{Side::columns, Which::all}},
            {{Side::columns, Which::tall}, {Side::none, Which::all}, {Side::rows, Which::all}},
            {{Side::rows, Which::wide}, {Side::none, Which::all}, {Side::columns, Which::all}},
        };
        std::optional<Growing> best;
        for (const std::vector<Step>& way : kWays) {
            Growing state = state_of(p);
            for (const Step& step : way) place(step, p, max_page, state);
            const bool better = !best || state.page.used > best->page.used ||
                                (state.page.used == best->page.used && state.area() < best->area());
            if (better) best = std::move(state);
        }
        return std::move(*best);
    }

    [[nodiscard]] bool is_meant(const ChartMask& mask, Which which) const {
        return which == Which::all || (mask.height > mask.width) == (which == Which::tall);
    }

    // What waits, is meant and fits. Columns are the rows of the page turned over.
    void place(const Step& step, std::uint32_t p, std::uint32_t max_page, Growing& state) {
        const bool turned = step.side == Side::columns;
        PackPage& page = state.page;
        const std::uint32_t across = turned ? page.height : page.width, along = turned ? page.width : page.height;
        const std::uint32_t most = step.side == Side::none ? along : max_page;
        if (state.waiting.empty() || context_.cancelled() || (step.side != Side::none && along >= max_page)) return;
        std::vector<std::uint32_t> tried, mask_of, left;
        for (const std::uint32_t i : state.waiting) {
            const ChartMask& mask = masks_[items_[i].mask];
            const bool fits =
                (turned ? mask.height : mask.width) <= across && (turned ? mask.width : mask.height) <= most;
            const bool takes = fits && is_meant(mask, step.which);
            (takes ? tried : left).push_back(i);
            if (takes) mask_of.push_back(items_[i].mask);
        }
        if (tried.empty()) return;
        std::vector<FixedMask> fixed = state.fixed;
        if (turned) {
            for (FixedMask& f : fixed) {
                std::swap(f.x, f.y);
                turn(f.mask);
            }
            for (const std::uint32_t m : mask_of) turn(m);
        }
        FillOptions options;
        options.width = across;
        options.height = most;
        options.orientations = Orientations::one;
        options.fixed = fixed;
        const PageFill filled =
            fill_page(turned ? std::span<const ChartMask>(turned_) : masks_, mask_of, options, context_);
        for (std::size_t k = 0; k < tried.size(); ++k) {
            const PageSpot& spot = filled.spots[k];
            if (!spot.placed) {
                left.push_back(tried[k]);
                continue;
            }
            const PackSpot at = turned ? PackSpot{p, spot.y, spot.x} : PackSpot{p, spot.x, spot.y};
            const ChartMask& mask = masks_[mask_of[k]];
            state.placed.emplace_back(tried[k], at);
            state.fixed.push_back({mask_of[k], at.x, at.y});
            const std::uint32_t end = turned ? at.x + mask.width : at.y + mask.height;
            std::uint32_t& edge = turned ? page.width : page.height;
            edge = std::max(edge, std::min((end + 3) / 4 * 4, most));
        }
        page.used += filled.used;
        std::ranges::sort(left);
        state.waiting = std::move(left);
    }

    void turn(std::uint32_t mask) {
        if (turned_.empty()) turned_.resize(masks_.size());
        if (turned_[mask].bits.empty()) turned_[mask] = oriented(masks_[mask], kTranspose);
    }

    // What waits, on pages of its own.
    [[nodiscard]] Packing new_pages(std::uint32_t max_page) const {
        std::vector<PackItem> items;
        for (const std::uint32_t i : waiting_) items.push_back(items_[i]);
        return pack(masks_, items, max_page, context_);
    }

    void add_pages(const Packing& more) {
        if (waiting_.empty() || !more.complete) return;
        const auto first = static_cast<std::uint32_t>(result_.pages.size());
        for (std::size_t k = 0; k < waiting_.size(); ++k)
            result_.spots[waiting_[k]] = {first + more.spots[k].page, more.spots[k].x, more.spots[k].y};
        result_.pages.insert(result_.pages.end(), more.pages.begin(), more.pages.end());
        waiting_.clear();
    }

    std::span<const ChartMask> masks_;
    std::span<const PackItem> items_;
    Context& context_;
    std::vector<std::vector<FixedMask>> fixed_;  // per page
    std::vector<std::uint32_t> waiting_;         // items, ascending
    std::vector<ChartMask> turned_;              // x and y swapped, those that were asked for
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
    return AroundPacker(masks, items, kept, pages, context).run(max_page);
}

}  // namespace lumel
