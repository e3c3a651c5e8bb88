// Choosing one of many items with given weights from one random number.
// A random float has 24 bits, so probabilities are shares of 2^24: what is reported is exactly how often an item is
// chosen, and an estimator that divides by it has no rounding bias. Inversion keeps the stratification of the points.
#pragma once

#include <cstdint>
#include <span>

namespace lumel {

inline constexpr std::uint32_t kUnits = 1u << 24;

// ends[i]: the first unit beyond item i; items are consecutive from 0 and the last ends at kUnits. The first
// `guaranteed` items get at least one unit each, however small their weight; others may get none. Weights are >= 0;
// where all are zero they count as equal. Preconditions: not empty, guaranteed < kUnits / 2.
void share_units(std::span<const double> weights, std::size_t guaranteed, std::span<std::uint32_t> ends);

struct Choice {
    std::size_t index;
    std::uint32_t units;  // its probability times kUnits, > 0
    float fraction;  // where in the item's interval the number fell, (0, 1): a fresh random number, if a coarse one
};

inline std::uint32_t unit_of(float u) {
    const auto unit = static_cast<std::uint32_t>(u * 0x1p24f);
    return unit < kUnits ? unit : kUnits - 1;
}

Choice choose(std::span<const std::uint32_t> ends, float u);

inline std::uint32_t units_of(std::span<const std::uint32_t> ends, std::size_t index) {
    return index == 0 ? ends[0] : ends[index] - ends[index - 1];
}
constexpr float probability(std::uint32_t units) { return static_cast<float>(units) * 0x1p-24f; }

}  // namespace lumel
