#include "math/discrete.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace lumel {

void share_units(std::span<const double> weights, std::size_t guaranteed, std::span<std::uint32_t> ends) {
    double total = 0.0;
    for (const double w : weights) total += w;
    LUMEL_CHECK(std::isfinite(total), total);
    const auto free_units = static_cast<double>(kUnits - guaranteed);
    const auto count = static_cast<double>(weights.size());
    // Rounding the running sum, not the items, keeps every error below one unit; at the end it equals the total
    // exactly.
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        const double share = total > 0.0 ? sum / total : static_cast<double>(i + 1) / count;
        ends[i] =
            static_cast<std::uint32_t>(share * free_units) + static_cast<std::uint32_t>(std::min(i + 1, guaranteed));
    }
}

Choice choose(std::span<const std::uint32_t> ends, float u) {
    const std::uint32_t unit = unit_of(u);
    const auto found = std::upper_bound(ends.begin(), ends.end(), unit);
    const auto index = static_cast<std::size_t>(found - ends.begin());
    const std::uint32_t begin = index == 0 ? 0 : ends[index - 1];
    const std::uint32_t units = *found - begin;
    return {index, units, (static_cast<float>(unit - begin) + 0.5f) / static_cast<float>(units)};
}

}  // namespace lumel
