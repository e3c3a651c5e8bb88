#include "path/hemisphere_guide.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumel {
namespace {

constexpr std::uint32_t kFewestSamples = 512;  // of both halves: one a bin, nine for what it is blurred from
constexpr float kLeastGain = 1.15f;            // below which a guide is not worth its own cost
// Of the mean moment, added to each bin: a bin in which no path has met anything may still hold some light.
constexpr float kUnseen = 0.02f;

using Bins = std::array<float, HemisphereGuide::kBins>;

float sum(const Bins& bins) { return std::accumulate(bins.begin(), bins.end(), 0.0f); }

// Each bin with its neighbours: a triangle filter of three bins along the azimuth, which is round, and the cosine.
Bins blurred(const Bins& in) {
    constexpr std::size_t kRows = HemisphereGuide::kRows, kColumns = HemisphereGuide::kColumns;
    Bins across, out;
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t column = 0; column < kColumns; ++column) {
            const float* const bins = &in[row * kColumns];
            across[row * kColumns + column] = 0.5f * bins[column] + 0.25f * bins[(column + 1) % kColumns] +
                                              0.25f * bins[(column + kColumns - 1) % kColumns];
        }
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t column = 0; column < kColumns; ++column) {
            const std::size_t above = row > 0 ? row - 1 : row, below = row + 1 < kRows ? row + 1 : row;
            out[row * kColumns + column] = 0.5f * across[row * kColumns + column] +
                                           0.25f * across[above * kColumns + column] +
                                           0.25f * across[below * kColumns + column];
        }
    return out;
}

// The density of least variance: the root of the second moment.
Bins root(const Bins& moments) {
    Bins out = blurred(moments);
    const float floor = kUnseen * sum(moments) / static_cast<float>(moments.size());
    for (float& bin : out) bin = std::sqrt(bin + floor);
    return out;
}

constexpr float kBelowOne = 0x1.fffffep-1f;

// By how much the second moment that `seen` has would fall under a guide.
float predicted_gain(const HemisphereGuide& guide, const Bins& seen) {
    float guided = 0.0f;
    for (std::size_t bin = 0; bin < seen.size(); ++bin) {
        const std::size_t row = bin / HemisphereGuide::kColumns, column = bin % HemisphereGuide::kColumns;
        const Vec2 middle{(static_cast<float>(row) + 0.5f) / HemisphereGuide::kRows,
                          (static_cast<float>(column) + 0.5f) / HemisphereGuide::kColumns};
        guided += seen[bin] / guide.density(middle);
    }
    return guided > 0.0f ? sum(seen) / guided : 1.0f;
}

}  // namespace

HemisphereGuide::HemisphereGuide(const Bins& wanted) {
    const float scale = (1.0f - kFloor) * static_cast<float>(kBins) / sum(wanted);
    for (std::size_t bin = 0; bin < kBins; ++bin) density_[bin] = kFloor + wanted[bin] * scale;
    std::array<float, kRows> rows{};
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t column = 0; column < kColumns; ++column) rows[row] += density_[row * kColumns + column];
    const float all = std::accumulate(rows.begin(), rows.end(), 0.0f);
    float before = 0.0f;
    for (std::size_t row = 0; row < kRows; ++row) {
        row_start_[row] = before / all;
        before += rows[row];
        float* const starts = &bin_start_[row * (kColumns + 1)];
        float within = 0.0f;
        for (std::size_t column = 0; column < kColumns; ++column) {
            starts[column] = within / rows[row];
            within += density_[row * kColumns + column];
        }
        starts[kColumns] = 1.0f;
    }
    row_start_[kRows] = 1.0f;
}

HemisphereGuide::Draw HemisphereGuide::draw(Vec2 u) const {
    // The last start that is not above u: starts ascend strictly, for the floor is above zero.
    const auto interval = [](const float* starts, std::size_t count, float value) {
        std::size_t i = 0;
        while (i + 1 < count && starts[i + 1] <= value) ++i;
        return i;
    };
    const auto place = [](const float* starts, std::size_t i, std::size_t count, float value) {
        const float share = (value - starts[i]) / (starts[i + 1] - starts[i]);
        return std::min((static_cast<float>(i) + share) / static_cast<float>(count), kBelowOne);
    };
    const std::size_t row = interval(row_start_.data(), kRows, u.x);
    const float* const starts = &bin_start_[row * (kColumns + 1)];
    const std::size_t column = interval(starts, kColumns, u.y);
    return {{place(row_start_.data(), row, kRows, u.x), place(starts, column, kColumns, u.y)},
            density_[row * kColumns + column]};
}

std::optional<HemisphereGuide> GuideStatistics::learn() const {
    if (counts_[0] + counts_[1] < kFewestSamples) return std::nullopt;
    if (!(sum(moments_[0]) > 0.0f) || !(sum(moments_[1]) > 0.0f)) return std::nullopt;
    // A guide of one half must be good for the other, which knows nothing of its accidents.
    const float gain = std::min(predicted_gain(HemisphereGuide(root(moments_[0])), moments_[1]),
                                predicted_gain(HemisphereGuide(root(moments_[1])), moments_[0]));
    if (!(gain >= kLeastGain) || !std::isfinite(sum(moments_[0]) + sum(moments_[1]))) return std::nullopt;
    Bins both = moments_[0];
    for (std::size_t bin = 0; bin < both.size(); ++bin) both[bin] += moments_[1][bin];
    return HemisphereGuide(root(both));
}

}  // namespace lumel
