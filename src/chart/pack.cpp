#include "chart/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "lumel/scene.h"

namespace lumel {

// ---- One page -------------------------------------------------------------------------------------------------------

void PageBits::grow(std::uint32_t rows) {
    if (rows <= rows_) return;
    rows_ = std::max(rows, rows_ + rows_ / 2);
    bits_.resize(std::size_t{rows_} * words_per_row_, 0);
}

// 0 where the texel is free, else how many taken texels follow from it within 64.
std::uint32_t PageBits::skip_taken(std::uint32_t x, std::uint32_t y) const {
    const std::uint64_t* word = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    return static_cast<std::uint32_t>(std::countr_one(word[0] >> (x % 64)));
}

bool PageBits::fits(const ChartMask& mask, std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t shift = x % 64;
    const std::uint64_t* page = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    const std::uint64_t* row = mask.bits.data();
    for (std::uint32_t r = 0; r < mask.height; ++r, page += words_per_row_, row += mask.words_per_row)
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
            const std::uint64_t taken = shift == 0 ? page[w] : page[w] >> shift | page[w + 1] << (64 - shift);
            if (taken & row[w]) return false;
        }
    return true;
}

PageBits::Spot PageBits::find(const ChartMask& mask, std::uint32_t start_row, std::uint32_t height) {
    if (mask.width > width_ || mask.height > height) return {};
    // Every position needs the texel under the first one of the mask's top row.
    std::uint32_t lead = 0;
    while (lead + 1 < mask.width && !mask.get(lead, 0)) ++lead;
    for (std::uint32_t y = start_row; y + mask.height <= height; ++y) {
        grow(y + mask.height);
        for (std::uint32_t x = 0; x + mask.width <= width_;) {
            if (const std::uint32_t taken = skip_taken(x + lead, y)) {
                x += taken;
                continue;
            }
            if (fits(mask, x, y)) return {true, x, y};
            ++x;
        }
    }
    return {};
}

void PageBits::set(const ChartMask& mask, std::uint32_t x, std::uint32_t y) {
    grow(y + mask.height);
    const std::uint32_t shift = x % 64;
    std::uint64_t* page = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    const std::uint64_t* row = mask.bits.data();
    for (std::uint32_t r = 0; r < mask.height; ++r, page += words_per_row_, row += mask.words_per_row)
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
            page[w] |= row[w] << shift;
            if (shift != 0) page[w + 1] |= row[w] >> (64 - shift);
        }
}

void PageBits::clear(const ChartMask& mask, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t shift = x % 64;
    std::uint64_t* page = &bits_[std::size_t{y} * words_per_row_ + x / 64];
    const std::uint64_t* row = mask.bits.data();
    for (std::uint32_t r = 0; r < mask.height; ++r, page += words_per_row_, row += mask.words_per_row)
        for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
            page[w] &= ~(row[w] << shift);
            if (shift != 0) page[w + 1] &= ~(row[w] >> (64 - shift));
        }
}

// ---- Groups on pages ------------------------------------------------------------------------------------------------

namespace {

struct Group {
    std::uint32_t first, last;  // items
    std::uint64_t used;
};

class Packer {
public:
    Packer(std::span<const ChartMask> masks, std::span<const PackItem> items, const std::function<bool()>& cancelled)
        : masks_(masks), items_(items), cancelled_(cancelled) {
        result_.spots.resize(items.size());
    }

    Packing pages(std::uint32_t max_page) {
        std::vector<Group> waiting = groups();
        while (!waiting.empty()) {
            const std::vector<Group> before = waiting;
            fill_page(waiting, page_width(waiting, max_page), max_page);
            if (cancelled_()) return std::move(result_);
            if (waiting.size() == before.size()) spread_first(waiting);
        }
        trim(max_page);
        result_.complete = true;
        return std::move(result_);
    }

    Packing single(std::uint32_t width, std::uint32_t height) {
        stop_at_first_failure_ = true;
        PageBits bits(width);
        result_.complete = add_groups(bits, groups(), height).empty() && !cancelled_();
        if (result_.complete) close_page(width, height);
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

    // About square for what is left, or as wide as can be where that is more than one page.
    [[nodiscard]] std::uint32_t page_width(const std::vector<Group>& waiting, std::uint32_t max_page) const {
        double used = 0.0;
        std::uint32_t widest = 1;
        for (const Group& g : waiting) {
            used += static_cast<double>(g.used);
            for (std::uint32_t i = g.first; i < g.last; ++i) widest = std::max(widest, mask(i).width);
        }
        const double square = std::ceil(std::sqrt(used / 0.9));
        if (square >= 0.95 * max_page) return max_page;
        return std::min((std::max(static_cast<std::uint32_t>(square), widest) + 3) / 4 * 4, max_page);
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

    // Makes a page of groups from the queue: a first round of a little more than it can hold, then rounds of what may
    // fit the room that is left. A page that nothing stays on is dropped.
    void fill_page(std::vector<Group>& waiting, std::uint32_t width, std::uint32_t height) {
        constexpr int kRounds = 4;
        PageBits bits(width);
        on_page_.clear();
        const double area = static_cast<double>(width) * height;
        double room = 1.02 * area;
        std::vector<Group> refused;  // already came off this page
        for (int round = 0; round < kRounds && !waiting.empty(); ++round) {
            const std::vector<Group> chosen = choose(waiting, room, round == 0);
            const std::vector<Group> left = add_groups(bits, chosen, height);
            refused.insert(refused.end(), left.begin(), left.end());
            if (cancelled_() || chosen.empty() || on_page_.empty()) break;
            room = area;
            for (const std::uint32_t item : on_page_) room -= static_cast<double>(mask(item).used);
            room *= 0.95;
        }
        waiting.insert(waiting.end(), refused.begin(), refused.end());
        std::sort(waiting.begin(), waiting.end(), [](const Group& a, const Group& b) { return a.first < b.first; });
        if (!on_page_.empty()) close_page(width, 0);
    }

    // Takes groups out of the queue, in order, each that still has room; the very first one in any case where `always`.
    [[nodiscard]] static std::vector<Group> choose(std::vector<Group>& waiting, double room, bool always) {
        std::vector<Group> chosen, rest;
        for (const Group& g : waiting) {
            const double used = static_cast<double>(g.used);
            const bool take = used <= room || (always && chosen.empty());
            if (take) room -= used;
            (take ? chosen : rest).push_back(g);
        }
        waiting = std::move(rest);
        return chosen;
    }

    // Adds the groups to a page, largest chart first. Where a chart finds no room, the last groups come off again until
    // it does or its own group has to go; so the first group stays if it can be placed at all. Returns the groups that
    // came off, in order.
    std::vector<Group> add_groups(PageBits& bits, const std::vector<Group>& chosen, std::uint32_t height) {
        const std::vector<std::uint32_t> group_of = order_items(chosen);
        std::vector<std::vector<std::uint32_t>> placed(chosen.size());
        std::size_t staying = chosen.size();  // groups before this one are on the page
        const auto page = static_cast<std::uint32_t>(result_.pages.size());

        std::uint32_t start_row = 0, key = std::numeric_limits<std::uint32_t>::max();
        for (std::size_t k = 0; k < order_.size(); ++k) {
            if (k % 256 == 0 && cancelled_()) return chosen;
            const std::uint32_t item = order_[k], group = group_of[k];
            if (group >= staying) continue;
            const ChartMask& m = mask(item);
            if (m.width + m.height < key) start_row = 0, key = m.width + m.height;
            PageBits::Spot spot = bits.find(m, start_row, height);
            while (!spot.found && group < staying) {
                if (stop_at_first_failure_) return chosen;
                --staying;
                start_row = 0;
                if (placed[staying].empty()) continue;
                take_off(bits, placed[staying]);
                if (group < staying) spot = bits.find(m, start_row, height);
            }
            if (!spot.found) continue;
            start_row = spot.y;
            bits.set(m, spot.x, spot.y);
            result_.spots[item] = {page, spot.x, spot.y};
            placed[group].push_back(item);
        }
        for (const std::vector<std::uint32_t>& group : placed)
            on_page_.insert(on_page_.end(), group.begin(), group.end());
        return {chosen.begin() + static_cast<std::ptrdiff_t>(staying), chosen.end()};
    }

    void take_off(PageBits& bits, std::vector<std::uint32_t>& group) const {
        for (const std::uint32_t item : group) bits.clear(mask(item), result_.spots[item].x, result_.spots[item].y);
        group.clear();
    }

    // Sorts the items of the groups by width + height, the larger first; ties by height, then index. Returns the
    // position in `chosen` of each item's group.
    std::vector<std::uint32_t> order_items(const std::vector<Group>& chosen) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;  // item, group
        for (std::uint32_t g = 0; g < chosen.size(); ++g)
            for (std::uint32_t i = chosen[g].first; i < chosen[g].last; ++i) entries.emplace_back(i, g);
        std::sort(entries.begin(), entries.end(), [&](const auto& a, const auto& b) {
            const ChartMask &ma = mask(a.first), &mb = mask(b.first);
            const std::uint32_t ka = ma.width + ma.height, kb = mb.width + mb.height;
            if (ka != kb) return ka > kb;
            return ma.height != mb.height ? ma.height > mb.height : a.first < b.first;
        });
        std::vector<std::uint32_t> group_of;
        order_.clear();
        for (const auto& [item, group] : entries) order_.push_back(item), group_of.push_back(group);
        return group_of;
    }

    // Ends the page that on_page_ lies on; `height` 0: as high as it needs to be.
    void close_page(std::uint32_t width, std::uint32_t height) {
        PackPage page{width, height, 0};
        for (const std::uint32_t item : on_page_) {
            page.height = std::max(page.height, result_.spots[item].y + mask(item).height);
            page.used += mask(item).used;
        }
        result_.pages.push_back(page);
    }

    void trim(std::uint32_t max_page) {
        for (PackPage& page : result_.pages) page.height = std::min((page.height + 3) / 4 * 4, max_page);
    }

    std::span<const ChartMask> masks_;
    std::span<const PackItem> items_;
    const std::function<bool()>& cancelled_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> on_page_;  // items that stay on the current page
    bool stop_at_first_failure_ = false;
    Packing result_;
};

}  // namespace

Packing pack(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t max_page,
             const std::function<bool()>& cancelled) {
    return Packer(masks, items, cancelled).pages(max_page);
}

Packing pack_one_page(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t width,
                      std::uint32_t height, const std::function<bool()>& cancelled) {
    return Packer(masks, items, cancelled).single(width, height);
}

}  // namespace lumel
