#include "pack/tiny_charts.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <tuple>

#include "pack/kernels.h"

namespace lumel {
namespace {

// The texel in question is at this column and row of its window.
constexpr std::uint32_t kColumn = 12, kRow = 2;

// A tiny mask in one orientation, its first texel at (kColumn, kRow).
struct Variant {
    std::uint32_t kind = 0;
    std::uint8_t orientation = 0;
    std::uint32_t lead = 0;  // x of the first texel of its top row
    std::uint32_t width = 0, height = 0, priority = 0;
    TinyWindow texels{};
    std::int32_t own_stranded = 0;  // holes inside the mask that nothing can fill: no fault of a place
};

Variant make_variant(const ChartMask& mask, std::uint32_t kind, std::uint8_t orientation) {
    const ChartMask turned = oriented(mask, orientation);
    Variant out;
    out.kind = kind;
    out.orientation = orientation;
    out.lead = static_cast<std::uint32_t>(std::countr_zero(turned.bits[0]));
    out.width = turned.width;
    out.height = turned.height;
    const std::uint32_t shorter = std::min(mask.width, mask.height);
    out.priority = (shorter + (mask.is_rectangle() ? 0 : 1)) * 1000 + turned.width * 10;
    for (std::uint32_t y = 0; y < turned.height; ++y)
        out.texels[kRow + y] = static_cast<std::uint32_t>(turned.bits[y] << (kColumn - out.lead));
    TinyWindow rest;
    for (std::uint32_t r = 0; r < kTinyRows; ++r) rest[r] = ~out.texels[r];
    out.own_stranded = kernels().stranded(rest);
    return out;
}

// The 8 rows from kRow on, 16 columns from kColumn - 7 on: all that a mask whose first texel is there can touch.
struct Reach {
    std::uint64_t upper = 0, lower = 0;
};
Reach reach_of(const TinyWindow& texels) {
    const auto four = [&](std::uint32_t row) {
        std::uint64_t out = 0;
        for (std::uint32_t r = 0; r < 4; ++r)
            out |= std::uint64_t{(texels[row + r] >> (kColumn - 7)) & 0xffffu} << (16 * r);
        return out;
    };
    return {four(kRow), four(kRow + 4)};
}

class TinyCharts {
public:
    TinyCharts(PageWork& work, std::span<const std::uint32_t> kinds) : work_(work), kernels_(kernels()) {
        // So many different masks fill holes as they are, and each orientation takes more memory than its mask does.
        constexpr std::size_t kTurned = 250'000;
        const bool turn = work.strategy.turn_tiny && kinds.size() <= kTurned;
        left_.resize(work.kinds.kinds.size(), 0);
        variants_of_.resize(left_.size(), 0);
        if (!turn) variants_.reserve(kinds.size());
        for (const std::uint32_t k : kinds) {
            const Kind& kind = work.kinds.kinds[k];
            if (work.cancelled()) return;
            left_[k] = kind.count;
            remaining_ += kind.count;
            for (const std::uint8_t o : distinct_orientations(*kind.mask, turn)) {
                variants_.push_back(make_variant(*kind.mask, k, o));
                ++variants_of_[k];
            }
        }
        // Alike ones side by side: their clusters have much in common.
        std::stable_sort(variants_.begin(), variants_.end(), [](const Variant& a, const Variant& b) {
            return std::tie(a.priority, b.lead) > std::tie(b.priority, a.lead);
        });
        index();
    }

    void run() {
        const std::uint32_t words = (work_.map.width() + 63) / 64;
        for (std::uint32_t y = 0; y < work_.map.height() && remaining_ > 0 && !work_.cancelled(); ++y) {
            work_.map.reach(y + kTinyRows);
            std::uint64_t* row = work_.map.texels(y);
            for (std::uint32_t w = 0; w < words && remaining_ > 0; ++w)
                while (row[w] != 0 && remaining_ > 0 && !work_.cancelled())
                    fill_hole(w * 64 + static_cast<std::uint32_t>(std::countr_zero(row[w])), y);
        }
    }

private:
    // The masks as first_disjoint wants them, and per cluster what they have in common.
    struct Table {
        std::vector<std::uint64_t> upper, lower;
        void resize(std::size_t size) {
            size = (size + kCluster - 1) / kCluster * kCluster;
            upper.assign(size, ~std::uint64_t{0});
            lower.assign(size, ~std::uint64_t{0});
        }
    };
    static constexpr std::size_t kCluster = 16;  // first_disjoint reads as many at a time

    void index() {
        clusters_ = (variants_.size() + kCluster - 1) / kCluster;
        masks_.resize(variants_.size());
        common_.resize(clusters_);
        for (std::size_t i = 0; i < variants_.size(); ++i) {
            const Reach reach = reach_of(variants_[i].texels);
            common_.upper[i / kCluster] &= masks_.upper[i] = reach.upper;
            common_.lower[i / kCluster] &= masks_.lower[i] = reach.lower;
        }
    }

    // The first variant from `from` on that fits where this is taken, or their number.
    [[nodiscard]] std::size_t next_variant(std::size_t from, const Reach& taken) const {
        const auto find = [&](const Table& table, std::size_t begin, std::size_t end) {
            return kernels_.first_disjoint(table.upper.data(), table.lower.data(), begin, end, taken.upper,
                                           taken.lower);
        };
        for (std::size_t c = from / kCluster; (c = find(common_, c, clusters_)) < clusters_; ++c) {
            const std::size_t end = std::min((c + 1) * kCluster, variants_.size());
            const std::size_t i = find(masks_, std::max(from, c * kCluster), end);
            if (i < end) return i;
        }
        return variants_.size();
    }

    // What is left of a window; rows and columns off the page are not free.
    void read_window(std::uint32_t x, std::uint32_t y, TinyWindow& out) {
        const std::uint32_t at = x + 64 - kColumn, shift = at % 64;
        const std::uint64_t* words = work_.map.row(0, std::int64_t{y} - kRow) + at / 64 - 1;
        for (std::uint32_t r = 0; r < kTinyRows; ++r, words += work_.map.stride())
            out[r] = static_cast<std::uint32_t>(words[0] >> shift | words[1] << (63 - shift) << 1);
    }

    // Puts the best chart on this texel, or gives the texel up.
    void fill_hole(std::uint32_t x, std::uint32_t y) {
        TinyWindow window;
        read_window(x, y, window);
        const std::size_t best = best_variant(window);
        if (best == variants_.size()) {
            work_.map.texels(y)[x / 64] &= ~(std::uint64_t{1} << (x % 64));
            return;
        }
        const Variant& v = variants_[best];
        take(v, x, y);
        const Kind& kind = work_.kinds.kinds[v.kind];
        work_.placed(work_.kinds.charts[kind.first + kind.count - left_[v.kind]], *kind.mask, v.orientation, x - v.lead,
                     y, y + v.height);
        --remaining_;
        if (--left_[v.kind] == 0) forget(v.kind);
    }

    std::size_t best_variant(const TinyWindow& window) {
        const Reach free = reach_of(window), taken{~free.upper, ~free.lower};
        std::size_t best = variants_.size();
        std::int32_t least = std::numeric_limits<std::int32_t>::max(), before = 0;
        std::uint32_t trials = 0;
        for (std::size_t i = 0;; ++i) {
            i = next_variant(i, taken);
            if (i == variants_.size()) return best;
            const Variant& v = variants_[i];
            if (left_[v.kind] == 0) continue;
            if (trials == 0) before = kernels_.stranded(window);
            TinyWindow after;
            for (std::uint32_t r = 0; r < kTinyRows; ++r) after[r] = window[r] & ~v.texels[r];
            const std::int32_t stranded = kernels_.stranded(after) - before - v.own_stranded;
            if (stranded < least) {
                least = stranded;
                best = i;
            }
            if (least <= 0 || ++trials >= work_.strategy.tiny_trials) return best;
        }
    }

    void take(const Variant& v, std::uint32_t x, std::uint32_t y) {
        const std::uint32_t at = x + 64 - kColumn, shift = at % 64;
        std::uint64_t* words = work_.map.texels(y) + at / 64 - 1;
        for (std::uint32_t r = 0; r < v.height; ++r, words += work_.map.stride()) {
            const std::uint64_t texels = v.texels[kRow + r];
            words[0] &= ~(texels << shift);
            words[1] &= ~(texels >> 1 >> (63 - shift));
        }
    }

    // Variants of kinds that are used up slow the search; they are thrown out where they are an eighth of all: so each
    // costs a few of the others, however many there are.
    void forget(std::uint32_t kind) {
        exhausted_ += variants_of_[kind];
        if (exhausted_ * 8 < variants_.size()) return;
        exhausted_ = 0;
        std::erase_if(variants_, [&](const Variant& v) { return left_[v.kind] == 0; });
        index();
    }

    PageWork& work_;
    const Kernels& kernels_;
    std::vector<std::uint32_t> left_;  // charts per kind
    std::size_t remaining_ = 0;
    std::vector<std::uint8_t> variants_of_;  // per kind
    std::size_t exhausted_ = 0;              // variants
    std::vector<Variant> variants_;
    std::size_t clusters_ = 0;
    Table masks_, common_;
};

}  // namespace

bool is_tiny(const ChartMask& mask) {
    if (mask.width > kTinySize || mask.height > kTinySize) return false;
    std::uint64_t all = 0;
    for (const std::uint64_t row : mask.bits) all |= row;
    return mask.bits.front() != 0 && mask.bits.back() != 0 && (all & 1) != 0 && (all >> (mask.width - 1)) != 0;
}

void place_tiny_charts(PageWork& work, std::span<const std::uint32_t> kinds) {
    if (!kinds.empty()) TinyCharts(work, kinds).run();
}

}  // namespace lumel
