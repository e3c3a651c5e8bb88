// Chart masks of a made-up level, for the packer: far more tiny charts than large ones, irregular shapes among them.
#pragma once

#include <cstdint>
#include <vector>

#include "pack/mask.h"

namespace lumel::samples {

// The defaults have the published figures of a level of a shipped game (O'Donnell 2018): 263,000 charts, 10.1 million
// texels. How sizes and shapes are spread is a guess: extents fall off by a power law.
struct LevelMasks {
    std::uint32_t charts = 263'000;
    double texels = 10.1e6;
    std::uint64_t seed = 1;
    bool instanced = true;   // meshes are placed many times: few different masks. false: each chart is drawn alone
    double fall_off = 1.9;   // exponent of the extents; larger: fewer large charts
    double largest = 620.0;  // extent, texels
};

// The same on every platform but for the rounding of pow, exp, sin and cos; about as many texels as asked.
std::vector<ChartMask> level_masks(const LevelMasks& level);

}  // namespace lumel::samples
