#include "pack/fill_page.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "pack/large_charts.h"
#include "pack/tiny_charts.h"

namespace lumel {
namespace {

// Rows that no page ever reaches.
constexpr std::uint32_t kNoLimit = 1u << 30;

struct Sorted {
    std::vector<std::uint32_t> large, tiny;  // kinds
    std::uint32_t max_level = 1;
};

Sorted sort_kinds(const Kinds& kinds) {
    Sorted out;
    for (std::uint32_t k = 0; k < kinds.kinds.size(); ++k) {
        const ChartMask& mask = *kinds.kinds[k].mask;
        if (is_tiny(mask)) {
            out.tiny.push_back(k);
        } else {
            out.large.push_back(k);
            out.max_level = std::max(out.max_level, level_of(mask));
        }
    }
    return out;
}

// Turned large charts cost up to eight times the search and only pay where no mass of tiny charts fills what they
// leave. A few charts are packed so fast that the best of several ways can be taken.
std::vector<Strategy> strategies(std::size_t charts, std::uint64_t texels, Orientations orientations) {
    constexpr std::size_t kTurned = 50'000, kSeveral = 6'000;
    constexpr std::uint64_t kSeveralTexels = 1'000'000;
    Strategy first;
    first.turn_large =
        orientations == Orientations::eight || (orientations == Orientations::automatic && charts <= kTurned);
    first.turn_tiny = orientations != Orientations::one;
    if (first.turn_large) {
        first.candidates = 16;
        first.stranded_weight = 1;
    }
    if (charts > kSeveral || texels > kSeveralTexels) return {first};
    first.stranded_weight = 1;
    first.candidates = 64;
    std::vector<Strategy> out(3, first);
    out[1].stranded_weight = 0;
    out[2].irregular_first = false;
    return out;
}

// Taken before any chart is placed.
void take_fixed(std::span<const ChartMask> masks, std::span<const FixedMask> fixed, std::uint32_t max_level,
                PageWork& work) {
    for (const FixedMask& f : fixed) {
        work.map.take(masks[f.mask], f.x, f.y, max_level);
        work.fill.height = std::max(work.fill.height, f.y + masks[f.mask].height);
    }
}

PageFill fill(std::span<const ChartMask> masks, const Kinds& kinds, const Sorted& sorted, const Strategy& strategy,
              std::size_t charts, const FillOptions& options, const Context& context,
              const std::function<void(std::size_t)>& on_placed) {
    PageWork work(kinds, strategy, options.width, options.height == 0 ? kNoLimit : options.height, sorted.max_level,
                  charts);
    work.cancelled = [&context] { return context.cancelled(); };
    work.on_placed = on_placed;
    work.all_or_nothing = options.all_or_nothing;
    take_fixed(masks, options.fixed, sorted.max_level, work);
    if (place_large_charts(work, sorted.large)) place_tiny_charts(work, sorted.tiny);
    return std::move(work.fill);
}

bool is_better(const PageFill& a, const PageFill& b) {
    return a.used != b.used ? a.used > b.used : a.height < b.height;
}

}  // namespace

PageFill fill_page(std::span<const ChartMask> masks, std::span<const std::uint32_t> mask_of, const FillOptions& options,
                   Context& context) {
    LUMEL_CHECK(options.width > 0 && options.width <= FreeMap::kMaxWidth, options.width);
    const Kinds kinds = group_equal(masks, mask_of);
    const Sorted sorted = sort_kinds(kinds);
    std::uint64_t texels = 0;
    for (const std::uint32_t m : mask_of) {
        LUMEL_CHECK(masks[m].width <= options.width || options.height != 0, m, masks[m].width);
        texels += masks[m].used;
    }
    const std::vector<Strategy> all = strategies(mask_of.size(), texels, options.orientations);
    if (all.size() == 1) return fill(masks, kinds, sorted, all[0], mask_of.size(), options, context, options.on_placed);
    std::vector<PageFill> fills(all.size());
    fills[0].spots.resize(mask_of.size());  // where cancelled before it began
    parallel_for(context, all.size(), 1, [&](const ChunkRange& range) {
        fills[range.index] = fill(masks, kinds, sorted, all[range.index], mask_of.size(), options, context, {});
    });
    std::size_t best = 0;
    for (std::size_t i = 1; i < fills.size(); ++i)
        if (is_better(fills[i], fills[best])) best = i;
    return std::move(fills[best]);
}

}  // namespace lumel
