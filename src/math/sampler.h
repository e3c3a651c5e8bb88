// Random numbers as a pure function of (seed, texel, sample, dimension): Owen-scrambled Sobol points.
// Based on: Burley 2020, "Practical Hash-based Owen Scrambling" (JCGT 9:4); Joe and Kuo 2008 for the direction numbers.
// Dimensions beyond the second are padded: pairs, each an independently shuffled and scrambled sequence.
#pragma once

#include <cstdint>

#include "lumel/vec.h"

namespace lumel {

// A float in [0, 1) from the high 24 bits.
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

constexpr std::uint32_t mix32(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// `key` identifies the point set (seed and texel), `index` the sample in it.
class Sampler {
public:
    Sampler(std::uint32_t key, std::uint32_t index) : key_(key), index_(index) {}

    // The two numbers of a pair of dimensions; `pair` counts pairs from 0. Independent of the order of calls.
    [[nodiscard]] Vec2 pair(std::uint32_t pair) const;
    [[nodiscard]] float one(std::uint32_t pair_index) const { return pair(pair_index).x; }
    // A hash of (key, index, salt): for decisions that need no stratification.
    [[nodiscard]] std::uint32_t hash(std::uint32_t salt) const {
        return mix32(mix32(key_ ^ salt * 0x9e3779b9u) + index_ * 0x85ebca6bu);
    }

private:
    std::uint32_t key_, index_;
};

// Key of a texel's point set, from 64-bit seed and the texel's global id (page and position).
std::uint32_t sampler_key(std::uint64_t seed, std::uint64_t id);

}  // namespace lumel
