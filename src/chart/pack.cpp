#include "chart/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
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
    bool alone;  // came off a page that it had to itself
};

class Packer {
public:
    Packer(std::span<const ChartMask> masks, std::span<const PackItem> items, const std::function<bool()>& cancelled)
        : masks_(masks), items_(items), cancelled_(cancelled) {
        result_.spots.resize(items.size());
    }

    Packing pages(std::uint32_t max_page) {
        std::deque<Group> waiting = groups();
        while (!waiting.empty()) {
            const std::vector<Group> chosen = choose(waiting, max_page);
            const std::vector<Group> left = fill_page(chosen, page_width(chosen, max_page), max_page);
            if (cancelled_()) return std::move(result_);
            if (left.size() == chosen.size())
                retry_smaller(waiting, left);
            else
                waiting.insert(waiting.begin(), left.begin(), left.end());
        }
        trim(max_page);
        result_.complete = true;
        return std::move(result_);
    }

    Packing single(std::uint32_t width, std::uint32_t height) {
        const std::deque<Group> all = groups();
        stop_at_first_failure_ = true;
        result_.complete = fill_page({all.begin(), all.end()}, width, height).empty() && !cancelled_();
        for (PackPage& page : result_.pages) page.width = width, page.height = height;
        return std::move(result_);
    }

private:
    [[nodiscard]] const ChartMask& mask(std::uint32_t item) const { return masks_[items_[item].mask]; }

    [[nodiscard]] std::deque<Group> groups() const {
        std::deque<Group> out;
        for (std::uint32_t i = 0; i < items_.size(); ++i) {
            LUMEL_CHECK(i == 0 || items_[i - 1].group <= items_[i].group, i);
            if (i == 0 || items_[i - 1].group != items_[i].group) out.push_back({i, i, 0, false});
            out.back().last = i + 1;
            out.back().used += mask(i).used;
        }
        return out;
    }

    // Takes groups off the queue until they nearly fill a page.
    [[nodiscard]] static std::vector<Group> choose(std::deque<Group>& waiting, std::uint32_t max_page) {
        const double capacity = 0.95 * static_cast<double>(max_page) * max_page;
        std::vector<Group> chosen;
        double used = 0.0;
        const bool first_alone = waiting.front().alone;
        do {
            used += static_cast<double>(waiting.front().used);
            chosen.push_back(waiting.front());
            waiting.pop_front();
        } while (!first_alone && !waiting.empty() && used + static_cast<double>(waiting.front().used) <= capacity);
        return chosen;
    }

    [[nodiscard]] std::uint32_t page_width(const std::vector<Group>& chosen, std::uint32_t max_page) const {
        std::uint64_t used = 0;
        std::uint32_t widest = 1;
        for (const Group& g : chosen) {
            used += g.used;
            for (std::uint32_t i = g.first; i < g.last; ++i) widest = std::max(widest, mask(i).width);
        }
        const auto square = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(used) / 0.9)));
        return std::min((std::max(square, widest) + 3) / 4 * 4, max_page);
    }

    // No group of the page could stay: the first one gets a page to itself, and if that was it, its charts spread.
    static void retry_smaller(std::deque<Group>& waiting, const std::vector<Group>& left) {
        waiting.insert(waiting.begin(), left.begin(), left.end());
        Group first = waiting.front();
        if (!first.alone && left.size() > 1) {
            waiting.front().alone = true;
            return;
        }
        waiting.pop_front();
        LUMEL_CHECK(first.last - first.first > 1, "a chart larger than a page", first.first);
        const std::uint64_t share = first.used / (first.last - first.first);
        for (std::uint32_t i = first.last; i-- > first.first;) waiting.push_front({i, i + 1, share, false});
    }

    // Packs the groups on a new page, largest chart first. A group that does not fit comes off it again; those are
    // returned, in order. A page that nothing stays on is dropped.
    std::vector<Group> fill_page(const std::vector<Group>& chosen, std::uint32_t width, std::uint32_t height) {
        PageBits bits(width);
        const std::vector<std::uint32_t> group_of = order_items(chosen);
        std::vector<std::vector<std::uint32_t>> placed(chosen.size());
        std::vector<bool> evicted(chosen.size(), false);
        const auto page = static_cast<std::uint32_t>(result_.pages.size());

        std::uint32_t start_row = 0, key = std::numeric_limits<std::uint32_t>::max();
        for (std::size_t k = 0; k < order_.size(); ++k) {
            if (k % 256 == 0 && cancelled_()) return chosen;
            const std::uint32_t item = order_[k], group = group_of[k];
            if (evicted[group]) continue;
            const ChartMask& m = mask(item);
            if (m.width + m.height < key) start_row = 0, key = m.width + m.height;
            const PageBits::Spot spot = bits.find(m, start_row, height);
            if (spot.found) {
                start_row = spot.y;
                bits.set(m, spot.x, spot.y);
                result_.spots[item] = {page, spot.x, spot.y};
                placed[group].push_back(item);
                continue;
            }
            start_row = height;  // nothing of this size fits any more
            evicted[group] = true;
            if (stop_at_first_failure_) return chosen;
            for (const std::uint32_t p : placed[group]) bits.clear(mask(p), result_.spots[p].x, result_.spots[p].y);
            placed[group].clear();
        }
        return close_page(chosen, placed, evicted, width);
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

    std::vector<Group> close_page(const std::vector<Group>& chosen,
                                  const std::vector<std::vector<std::uint32_t>>& placed,
                                  const std::vector<bool>& evicted, std::uint32_t width) {
        std::vector<Group> left;
        PackPage page{width, 0, 0};
        for (std::size_t g = 0; g < chosen.size(); ++g) {
            if (evicted[g]) left.push_back(chosen[g]);
            for (const std::uint32_t item : placed[g]) {
                page.height = std::max(page.height, result_.spots[item].y + mask(item).height);
                page.used += mask(item).used;
            }
        }
        if (page.used > 0) result_.pages.push_back(page);
        return left;
    }

    void trim(std::uint32_t max_page) {
        for (PackPage& page : result_.pages) page.height = std::min((page.height + 3) / 4 * 4, max_page);
    }

    std::span<const ChartMask> masks_;
    std::span<const PackItem> items_;
    const std::function<bool()>& cancelled_;
    std::vector<std::uint32_t> order_;
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
