// How many samples each texel of a block needs, by what its neighbours have measured.
//
// A texel that stops when its own samples agree stops too early where light is rare: as long as it has missed the light
// it sees no noise. That darkens texels by up to a fifth (Frostbite's published rule, StopRule::flux). Here a texel's
// own samples have no say in its own decision: the noise that is taken for its own is the mean of the others of its
// block. (They have one in how many samples the others take, and in what guides them all: two steps away.)
#pragma once

#include <cstdint>
#include <span>

namespace lumel {

inline constexpr std::uint32_t kFewestAdaptiveSamples = 32;  // before the first decision
inline constexpr std::size_t kFewestNeighbours = 8;  // with fewer there is no decision: the whole budget is spent

// A texel so far, in luminance of irradiance, all included layers.
struct TexelProgress {
    double mean = 0.0;
    double half_difference = 0.0;  // of the means of its even and its odd samples
    std::uint32_t samples = 0;     // traced
    bool valid = false;            // has a mean in each half
};

// For each texel how many samples it should have, of at most `budget` and no fewer than it has, so that the standard
// error of its mean is `relative_error` of that mean.
void adaptive_samples(std::span<const TexelProgress> block, double relative_error, std::uint32_t budget,
                      std::span<std::uint32_t> wanted);

}  // namespace lumel
