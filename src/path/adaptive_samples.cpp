#include "path/adaptive_samples.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace lumel {
namespace {

constexpr double kMargin = 1.6;  // of the samples predicted: what is measured of a texel scatters around its block
constexpr std::uint32_t kMultiple = 16;  // of samples; even, so that the halves stay equal

// Student's t over the normal quantile at 97.5 %, as in pool_variance(): few neighbours say less.
double student(double count) { return 1.0 + 1.21 / count + 2.2 / (count * count); }

std::uint32_t rounded_up(double samples, std::uint32_t budget) {
    if (!(samples < static_cast<double>(budget))) return budget;
    const auto whole = static_cast<std::uint32_t>(std::ceil(samples));
    return std::min(budget, (whole + kMultiple - 1) / kMultiple * kMultiple);
}

}  // namespace

void adaptive_samples(std::span<const TexelProgress> block, double relative_error, std::uint32_t budget,
                      std::span<std::uint32_t> wanted) {
    LUMEL_CHECK(block.size() == wanted.size() && relative_error > 0.0, block.size(), wanted.size(), relative_error);
    // A quarter of the squared difference of the halves is what the mean of both errs; times the samples, what one
    // does.
    const auto variance_of_one = [](const TexelProgress& texel) {
        return 0.25 * texel.half_difference * texel.half_difference * texel.samples;
    };
    double variance = 0.0, mean = 0.0, count = 0.0;
    for (const TexelProgress& texel : block) {
        if (!texel.valid) continue;
        variance += variance_of_one(texel);
        mean += texel.mean;
        count += 1.0;
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
        const TexelProgress& texel = block[i];
        const double own = texel.valid ? 1.0 : 0.0, others = count - own;
        wanted[i] = std::max(texel.samples, budget);
        if (others < static_cast<double>(kFewestNeighbours)) continue;
        const double mean_of_others = (mean - own * texel.mean) / others;
        const double t = student(others);
        // Differences of large sums: rounding may leave less than nothing.
        const double variance_of_others = std::max(0.0, (variance - own * variance_of_one(texel)) / others) * t * t;
        const double allowed = relative_error * mean_of_others;
        const double needed = kMargin * variance_of_others / (allowed * allowed);
        // Where the others have seen no light yet nothing is known.
        if (!(mean_of_others > 0.0)) continue;
        wanted[i] = std::max({texel.samples, std::min(budget, kFewestAdaptiveSamples), rounded_up(needed, budget)});
    }
}

}  // namespace lumel
