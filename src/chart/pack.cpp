#include "chart/pack.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "pack/fill_page.h"

namespace lumel {
namespace {

struct Group {
    std::uint32_t first, last;  // items
    std::uint64_t used;
};

std::uint64_t used_by(const std::vector<Group>& groups) {
    std::uint64_t used = 0;
    for (const Group& g : groups) used += g.used;
    return used;
}

// A page and the groups that are on it as a whole.
struct Filled {
    std::vector<Group> groups;
    std::vector<PackSpot> spots;  // beside the items of those groups
    std::uint64_t used = 0;
    std::uint32_t width = 0, height = 0;  // of the page
};

class Packer {
public:
    Packer(std::span<const ChartMask> masks, std::span<const PackItem> items, Context& context)
        : masks_(masks), items_(items), context_(context) {
        result_.spots.resize(items.size());
    }

    Packing pages(std::uint32_t max_page) {
        std::vector<Group> waiting = groups();
        while (!waiting.empty()) {
            const Filled page = best_shape(waiting, max_page);
            if (context_.cancelled()) return std::move(result_);
            if (page.groups.empty()) {
                spread_first(waiting);
                continue;
            }
            close_page(page, 0);
            std::erase_if(waiting, [&](const Group& g) {
                return std::ranges::binary_search(page.groups, g.first, {}, &Group::first);
            });
        }
        for (PackPage& page : result_.pages) page.height = std::min((page.height + 3) / 4 * 4, max_page);
        result_.complete = true;
        return std::move(result_);
    }

    Packing single(std::uint32_t width, std::uint32_t height) {
        const std::vector<Group> all = groups();
        const Filled page = fill(all, width, height, true);
        result_.complete = page.groups.size() == all.size() && !context_.cancelled();
        if (result_.complete) close_page(page, height);
        return std::move(result_);
    }

private:
    [[nodiscard]] const ChartMask& mask(std::uint32_t item) const { return masks_[items_[item].mask]; }

    [[nodiscard]] std::vector<Group> groups() const {
        std::vector<Group> out;
        for (std::uint32_t i = 0; i < items_.size(); ++i) {
            LUMEL_CHECK(i == 0 || items_[i - 1].group <= items_[i].group, i);
            if (i == 0 || items_[i - 1].group != items_[i].group) out.push_back({i, i, 0});
            out.back().last = i + 1;
            out.back().used += mask(i).used;
        }
        return out;
    }

    // Where a few charts fill a page, whether the largest lie side by side decides: several widths are tried.
    Filled best_shape(const std::vector<Group>& waiting, std::uint32_t max_page) {
        constexpr std::size_t kFewItems = 10'000;
        const std::uint32_t square = page_width(waiting, max_page);
        std::vector<double> factors{1.0};
        if (square < max_page && items_.size() <= kFewItems) factors = {1.0, 1.02, 1.04, 1.07, 1.1, 1.15, 0.95, 0.88};
        const std::uint32_t narrowest = std::min((widest(waiting) + 3) / 4 * 4, max_page);
        std::vector<std::uint32_t> tried;
        Filled best;
        for (const double factor : factors) {
            const auto wanted = static_cast<std::uint32_t>(factor * square + 3.0) / 4 * 4;
            const std::uint32_t width = factor == 1.0 ? square : std::clamp(wanted, narrowest, max_page);
            if (std::ranges::find(tried, width) != tried.end()) continue;
            tried.push_back(width);
            Filled page = best_page(waiting, width, max_page);
            if (is_better(page, best)) best = std::move(page);
        }
        return best;
    }

    // What a page does not hold opens another one, which costs more than a less dense page does.
    static bool is_better(const Filled& a, const Filled& b) {
        const std::uint64_t used_a = used_by(a.groups), used_b = used_by(b.groups);
        const auto area = [](const Filled& page) { return std::uint64_t{page.width} * ((page.height + 3) / 4 * 4); };
        return used_a != used_b ? used_a > used_b : used_a > 0 && area(a) < area(b);
    }

    [[nodiscard]] std::uint32_t widest(const std::vector<Group>& waiting) const {
        std::uint32_t width = 1;
        for (const Group& g : waiting)
            for (std::uint32_t i = g.first; i < g.last; ++i) width = std::max(width, mask(i).width);
        return width;
    }

    // About square for what is left, or as wide as can be where that is more than one page.
    [[nodiscard]] std::uint32_t page_width(const std::vector<Group>& waiting, std::uint32_t max_page) const {
        const double square = std::ceil(std::sqrt(static_cast<double>(used_by(waiting)) / 0.95));
        if (square >= 0.97 * max_page) return max_page;
        return std::min((std::max(static_cast<std::uint32_t>(square), widest(waiting)) + 3) / 4 * 4, max_page);
    }

    // The first group does not even fit an empty page: its charts become groups of their own.
    void spread_first(std::vector<Group>& waiting) const {
        const Group g = waiting.front();
        LUMEL_CHECK(g.last - g.first > 1, "a chart larger than a page", g.first);
        std::vector<Group> charts;
        for (std::uint32_t i = g.first; i < g.last; ++i) charts.push_back({i, i + 1, mask(i).used});
        waiting.erase(waiting.begin());
        waiting.insert(waiting.begin(), charts.begin(), charts.end());
    }

    // The most texels of whole groups, the first group among them, that a few tries bring on a page. A try takes groups
    // for as many texels as the one before it could place. No groups: the first one does not fit.
    Filled best_page(const std::vector<Group>& waiting, std::uint32_t width, std::uint32_t height) {
        constexpr int kTries = 4;
        constexpr double kAtFirst = 0.985, kLess = 0.995;
        double room = kAtFirst * width * height;
        Filled best;
        for (int i = 0; i < kTries && !context_.cancelled(); ++i) {
            const std::vector<Group> chosen = choose(waiting, room);
            Filled page = fill(chosen, width, height);
            const bool all = page.groups.size() == chosen.size();
            room = kLess * static_cast<double>(page.used);
            keep_better(best, std::move(page), waiting.front());
            if (all) return best;
        }
        if (best.groups.empty()) keep_better(best, fill({waiting.front()}, width, height), waiting.front());
        return best;
    }

    // Groups, in order, each that still has room; the first one in any case.
    [[nodiscard]] static std::vector<Group> choose(const std::vector<Group>& waiting, double room) {
        std::vector<Group> chosen;
        for (const Group& g : waiting) {
            const double used = static_cast<double>(g.used);
            if (used > room && !chosen.empty()) continue;
            room -= used;
            chosen.push_back(g);
        }
        return chosen;
    }

    static void keep_better(Filled& best, Filled page, const Group& needed) {
        const bool has_first = !page.groups.empty() && page.groups.front().first == needed.first;
        if (has_first && (best.groups.empty() || used_by(page.groups) > used_by(best.groups))) best = std::move(page);
    }

    // One page of as many charts of these groups as fit; `used` counts those of groups that are not on it as a whole,
    // too. All or nothing: fewer where not all do.
    Filled fill(const std::vector<Group>& chosen, std::uint32_t width, std::uint32_t height,
                bool all_or_nothing = false) {
        std::vector<std::uint32_t> mask_of;
        for (const Group& g : chosen)
            for (std::uint32_t i = g.first; i < g.last; ++i) mask_of.push_back(items_[i].mask);
        FillOptions options;
        options.width = width;
        options.height = height;
        options.orientations = Orientations::one;
        options.all_or_nothing = all_or_nothing;
        const PageFill page = fill_page(masks_, mask_of, options, context_);
        Filled out;
        out.used = page.used;
        out.width = width;
        std::size_t next = 0;
        for (const Group& g : chosen) {
            const std::span<const PageSpot> spots(page.spots.data() + next, g.last - g.first);
            next += spots.size();
            if (!std::ranges::all_of(spots, &PageSpot::placed)) continue;
            out.groups.push_back(g);
            for (std::uint32_t i = 0; i < spots.size(); ++i) {
                out.spots.push_back({0, spots[i].x, spots[i].y});
                out.height = std::max(out.height, spots[i].y + mask(g.first + i).height);
            }
        }
        return out;
    }

    // Of this height at least.
    void close_page(const Filled& filled, std::uint32_t height) {
        const PackPage page{filled.width, std::max(height, filled.height), used_by(filled.groups)};
        std::size_t next = 0;
        for (const Group& g : filled.groups)
            for (std::uint32_t i = g.first; i < g.last; ++i) {
                result_.spots[i] = filled.spots[next++];
                result_.spots[i].page = static_cast<std::uint32_t>(result_.pages.size());
            }
        result_.pages.push_back(page);
    }

    std::span<const ChartMask> masks_;
    std::span<const PackItem> items_;
    Context& context_;
    Packing result_;
};

}  // namespace

Packing pack(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t max_page,
             Context& context) {
    return Packer(masks, items, context).pages(max_page);
}

Packing pack_one_page(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t width,
                      std::uint32_t height, Context& context) {
    return Packer(masks, items, context).single(width, height);
}

}  // namespace lumel
