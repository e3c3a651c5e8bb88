#include "flux_numbers.h"

#include <array>

namespace lumel::bench {

float radical_inverse(std::uint32_t base, std::uint32_t index) {
    double value = 0.0, digit = 1.0;
    for (; index > 0; index /= base) {
        digit /= static_cast<double>(base);
        value += digit * static_cast<double>(index % base);
    }
    // A float that rounds to 1 would be outside the unit interval.
    return static_cast<float>(static_cast<std::uint32_t>(value * 0x1p24)) * 0x1p-24f;
}

HaltonTable::HaltonTable(std::uint32_t samples) : values_(std::size_t{samples} * kDimensions) {
    constexpr std::array<std::uint32_t, kDimensions> kPrimes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
    for (std::uint32_t s = 0; s < samples; ++s)
        for (std::uint32_t d = 0; d < kDimensions; ++d)
            values_[std::size_t{s} * kDimensions + d] = radical_inverse(kPrimes[d], s + 1);
}

float FluxNumbers::rotated(std::uint32_t vertex, std::uint32_t use, std::uint32_t which) const {
    if (vertex >= HaltonTable::kVertices) return independent(vertex, use, which);
    const float angle = unit_float(mix32(mix32(key_) + salt_of(vertex, use, which) * 0x9e3779b9u));
    const float sum = table_.at(index_, vertex * HaltonTable::kPerVertex + use) + angle;
    return sum >= 1.0f ? sum - 1.0f : sum;
}

Vec2 FluxNumbers::pair(std::uint32_t vertex, std::uint32_t use, std::uint32_t which) const {
    if (points_ == FluxPoints::sobol) return Sampler(key_, index_).pair(salt_of(vertex, use, which));
    return {rotated(vertex, use, which), rotated(vertex, use + 1, which)};
}

float FluxNumbers::one(std::uint32_t vertex) const {
    if (points_ == FluxPoints::sobol) return Sampler(key_, index_).one(salt_of(vertex, 2, 0));
    return rotated(vertex, 2, 0);
}

float FluxNumbers::roulette(std::uint32_t vertex) const {
    if (points_ == FluxPoints::sobol) return Sampler(key_, index_).pair(salt_of(vertex, 2, 0)).y;
    return independent(vertex, 5, 0);
}

}  // namespace lumel::bench
