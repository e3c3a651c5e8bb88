// Whether halves hold the light of a page.
#pragma once

#include <cstddef>
#include <span>

#include "encode/encoding.h"

namespace lumel {

// What is stored as half stays below this, and a mean above the other: below 65504, and far enough above the smallest
// steps.
inline constexpr float kLargestOfHalves = 65000.0f;
inline constexpr double kSmallestMeanOfHalves = 0.006;

struct LightRange {
    float largest = 0.0f;  // size of a number, without its sign
    double mean = 0.0;
};

LightRange light_range(std::span<const Numbers> texels, std::size_t first, std::size_t count);

inline bool halves_hold(const LightRange& range) {
    return range.largest < kLargestOfHalves && (range.largest == 0.0f || range.mean >= kSmallestMeanOfHalves);
}

}  // namespace lumel
