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

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

// A hash in which a bit depends on lower bits only: an Owen scramble of the reversed number.
// Constants: Vegdahl 2021 (improved Laine-Karras hash).
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Dimension 1 of Sobol, bit-reversed (dimension 0 is the index reversed): the product with Pascal's triangle modulo 2,
// of which each step takes in one bit of the columns' numbers.
// Based on: Ahmed 2024, "An Implementation Algorithm of 2D Sobol Sequence Fast, Elegant, and Compact" (EGSR).
constexpr std::uint32_t reversed_sobol_1(std::uint32_t index) {
    std::uint32_t x = index;
    x ^= (x >> 16) & 0x0000ffffu;
    x ^= (x >> 8) & 0x00ff00ffu;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 1) & 0x55555555u;
    return x;
}

// `key` identifies the point set (seed and texel), `index` the sample in it.
class Sampler {
public:
    Sampler(std::uint32_t key, std::uint32_t index) : key_(key), index_(index) {}

    // The two numbers of a pair of dimensions; `pair` counts pairs from 0. Independent of the order of calls.
    [[nodiscard]] Vec2 pair(std::uint32_t pair) const {
        const std::uint32_t seed = mix32(key_ + pair * 0x9e3779b9u);
        // Shuffle: an Owen scramble of the index keeps every aligned power-of-two block of samples a (0,2)-net.
        const std::uint32_t shuffled = reverse_bits(laine_karras(reverse_bits(index_), seed));
        const std::uint32_t x = reverse_bits(laine_karras(shuffled, mix32(seed ^ 0xa511e9b3u)));
        const std::uint32_t y = reverse_bits(laine_karras(reversed_sobol_1(shuffled), mix32(seed ^ 0x63d83595u)));
        return {unit_float(x), unit_float(y)};
    }
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
