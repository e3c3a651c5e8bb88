#include "pack/large_charts.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <tuple>

#include "pack/cover.h"
#include "pack/kernels.h"

namespace lumel {
namespace {

// The box of a mask and two texels around it.
class Frame {
public:
    explicit Frame(const ChartMask& mask) : columns_((mask.width + 4 + 63) / 64), rows_(mask.height + 4) {
        const std::size_t size = std::size_t{columns_ + 2} * rows_;
        mask_.resize(size, 0);
        rim_.resize(size, 0);
        side_.resize(size, 0);
        for (std::uint32_t y = 0; y < mask.height; ++y)
            for (std::uint32_t w = 0; w < mask.words_per_row; ++w) {
                const std::uint64_t word = mask.bits[std::size_t{y} * mask.words_per_row + w];
                mask_[at(w, y + 2)] |= word << 2;
                mask_[at(w + 1, y + 2)] |= word >> 62;
            }
        grow();
    }

    [[nodiscard]] FrameView view() const { return {columns_, rows_, mask_.data(), rim_.data(), side_.data()}; }
    [[nodiscard]] std::size_t scratch_words() const { return std::size_t{columns_ + 2} * rows_ * 3; }

private:
    [[nodiscard]] std::size_t at(std::uint32_t column, std::uint32_t row) const {
        return std::size_t{column + 1} * rows_ + row;
    }
    // Texels beside the mask, and those around it.
    void grow() {
        for (std::uint32_t c = 0; c < columns_; ++c)
            for (std::uint32_t r = 1; r + 1 < rows_; ++r) {
                const auto wide = [&](std::uint32_t row) {
                    const std::uint64_t m = mask_[at(c, row)];
                    return m << 1 | m >> 1 | mask_[at(c, row) - rows_] >> 63 | mask_[at(c, row) + rows_] << 63;
                };
                const std::uint64_t here = mask_[at(c, r)], up = mask_[at(c, r - 1)], down = mask_[at(c, r + 1)];
                side_[at(c, r)] = (wide(r) | up | down) & ~here;
                rim_[at(c, r)] = (wide(r) | up | down | wide(r - 1) | wide(r + 1)) & ~here;
            }
    }

    std::uint32_t columns_, rows_;
    std::vector<std::uint64_t> mask_, rim_, side_;
};

// A chart as it would be laid down, and how far the search for places of it has come.
struct Pose {
    std::uint8_t orientation;
    ChartMask mask;
    std::vector<CoverSquare> squares;
    std::optional<Frame> frame;   // where candidates are compared
    std::uint32_t first_row = 0;  // no position above it is left
};

struct Position {
    std::uint32_t pose = 0, x = 0, y = 0;
};

// Positions whose left or right neighbour is none.
FitSearch run_ends(const FitSearch& search) {
    FitSearch out = search;
    constexpr std::uint32_t n = FreeMap::kBlockWords;
    for (std::uint32_t w = 0; w < n; ++w) {
        const std::uint64_t fits = search.fits[w];
        const std::uint64_t left = w > 0 ? search.fits[w - 1] >> 63 : 0,
                            right = w + 1 < n ? search.fits[w + 1] << 63 : 0;
        out.fits[w] = fits & ~((fits << 1 | left) & (fits >> 1 | right));
    }
    return out;
}

// Up to the last row that is not empty.
std::uint32_t rows_used(const ChartMask& mask) {
    std::size_t words = mask.bits.size();
    while (words > 0 && mask.bits[words - 1] == 0) --words;
    return static_cast<std::uint32_t>((words + mask.words_per_row - 1) / mask.words_per_row);
}

class LargeCharts {
public:
    explicit LargeCharts(PageWork& work) : work_(work), kernels_(kernels()) {}

    // False where the page has no more place for charts of this kind.
    bool place(const Kind& kind, std::uint32_t max_level) {
        make_poses(*kind.mask, max_level);
        for (std::uint32_t i = 0; i < kind.count && !work_.cancelled(); ++i) {
            std::optional<Position> position;
            if (work_.strategy.candidates > 0) position = best_position();
            if (!position) position = lowest_position();
            if (!position) return work_.cancelled();  // else the others of the kind will not fit, either
            const Pose& pose = poses_[position->pose];
            work_.map.take(pose.mask, position->x, position->y, max_level);
            work_.placed(work_.kinds.charts[kind.first + i], pose.mask, pose.orientation, position->x, position->y,
                         position->y + rows_used(pose.mask));
        }
        return true;
    }

private:
    void make_poses(const ChartMask& mask, std::uint32_t max_level) {
        poses_.clear();
        const bool turn = work_.strategy.turn_large && worth_turning(mask);
        for (const std::uint8_t orientation : distinct_orientations(mask, turn)) {
            ChartMask turned = oriented(mask, orientation);
            if (turned.width > work_.map.width() || turned.height > work_.map.height()) continue;
            Pose pose{orientation, std::move(turned), {}, {}, 0};
            pose.squares = cover(pose.mask, max_level, work_.cancelled);
            if (work_.cancelled()) return poses_.clear();  // not all of it may be covered
            if (work_.strategy.candidates > 0) {
                pose.frame.emplace(pose.mask);
                scratch_.resize(std::max(scratch_.size(), pose.frame->scratch_words()));
            }
            poses_.push_back(std::move(pose));
        }
    }

    bool next_fit(const Pose& pose, std::uint32_t last_y, FitSearch& search) const {
        return kernels_.next_fit(work_.map, pose.squares.data(), pose.squares.size(),
                                 work_.map.width() - pose.mask.width, last_y, search);
    }

    // Among the rows in use: the best of the first candidates.
    std::optional<Position> best_position() {
        std::optional<Position> best;
        std::int32_t least = std::numeric_limits<std::int32_t>::max();
        for (std::uint32_t p = 0; p < poses_.size(); ++p) {
            Pose& pose = poses_[p];
            if (pose.mask.height > work_.fill.height) continue;
            const std::uint32_t last_y = work_.fill.height - pose.mask.height;
            if (pose.first_row > last_y) continue;
            work_.map.reach(work_.fill.height + 1);
            FitSearch search{pose.first_row, 0, {}};
            bool found = false;
            std::uint32_t seen = 0;
            while (seen < work_.strategy.candidates && !work_.cancelled() && next_fit(pose, last_y, search)) {
                if (!found) pose.first_row = search.y;
                found = true;
                compare(p, run_ends(search), seen, least, best);
                ++search.block;
            }
            if (!found) pose.first_row = last_y + 1;
        }
        return best;
    }

    void compare(std::uint32_t p, const FitSearch& ends, std::uint32_t& seen, std::int32_t& least,
                 std::optional<Position>& best) {
        const FrameView frame = poses_[p].frame->view();
        for (std::uint32_t w = 0; w < FreeMap::kBlockWords; ++w)
            for (std::uint64_t left = ends.fits[w]; left != 0; left &= left - 1) {
                if (seen++ == work_.strategy.candidates || work_.cancelled()) return;
                const std::uint32_t x =
                    ends.block * FreeMap::kBlockBits + w * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
                const std::uint64_t* texels = work_.map.row(0, std::int64_t{ends.y} - 2) + (x + 62) / 64 - 1;
                const FrameRating rating =
                    kernels_.rate(frame, texels, work_.map.stride(), (x + 62) % 64, scratch_.data());
                const std::int32_t cost = work_.strategy.stranded_weight * rating.stranded + rating.open;
                if (cost >= least) continue;
                least = cost;
                best = Position{p, x, ends.y};
            }
    }

    // The position, in new rows, too, that makes the page the least high; of those the first.
    std::optional<Position> lowest_position() {
        std::optional<Position> best;
        std::uint32_t bottom = std::numeric_limits<std::uint32_t>::max();
        for (std::uint32_t p = 0; p < poses_.size(); ++p) {
            Pose& pose = poses_[p];
            const std::uint32_t last_y =
                std::min(work_.fill.height, work_.map.height() - pose.mask.height);  // all is free from there on
            work_.map.reach(last_y + pose.mask.height);
            FitSearch search{pose.first_row, 0, {}};
            if (pose.first_row > last_y || !next_fit(pose, last_y, search)) {
                pose.first_row = last_y + 1;
                continue;
            }
            pose.first_row = search.y;
            if (search.y + pose.mask.height >= bottom) continue;
            bottom = search.y + pose.mask.height;
            std::uint32_t w = 0;
            while (search.fits[w] == 0) ++w;
            best = Position{p,
                            search.block * FreeMap::kBlockBits + w * 64 +
                                static_cast<std::uint32_t>(std::countr_zero(search.fits[w])),
                            search.y};
        }
        return best;
    }

    PageWork& work_;
    const Kernels& kernels_;
    std::vector<Pose> poses_;
    std::vector<std::uint64_t> scratch_;
};

}  // namespace

std::vector<std::uint8_t> distinct_orientations(const ChartMask& mask, bool turn) {
    if (!turn) return {0};
    std::vector<std::uint8_t> out;
    std::vector<ChartMask> seen;
    for (std::uint8_t o = 0; o < kOrientations; ++o) {
        ChartMask turned = oriented(mask, o);
        if (std::ranges::any_of(seen, [&](const ChartMask& other) { return same_texels(other, turned); })) continue;
        out.push_back(o);
        seen.push_back(std::move(turned));
    }
    return out;
}

std::uint32_t level_of(const ChartMask& mask) { return square_level(std::min(mask.width, mask.height)); }

bool place_large_charts(PageWork& work, std::span<const std::uint32_t> kinds) {
    std::vector<std::uint32_t> order(kinds.begin(), kinds.end());
    const auto key = [&](std::uint32_t k) {
        const ChartMask& m = *work.kinds.kinds[k].mask;
        // Of a size that opens rows wherever it goes: such charts must not come after others.
        const bool huge = m.width + m.height >= work.map.width() / 4;
        const bool early = work.strategy.irregular_first && !m.is_rectangle();
        return std::tuple(huge, huge || early, m.width + m.height, m.height, m.used);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka > kb : a < b;
    });
    // Levels that no later chart needs are no longer kept.
    std::vector<std::uint32_t> max_level(order.size(), 0);
    std::uint32_t level = 1;
    for (std::size_t i = order.size(); i-- > 0;)
        max_level[i] = level = std::max(level, level_of(*work.kinds.kinds[order[i]].mask));
    LargeCharts charts(work);
    for (std::size_t i = 0; i < order.size() && !work.cancelled(); ++i)
        if (!charts.place(work.kinds.kinds[order[i]], std::min(max_level[i], work.map.max_level())) &&
            work.all_or_nothing)
            return false;
    return true;
}

}  // namespace lumel
