// Two halves of a reference, independent of each other: brute force, run until enough samples are there or its time is
// up, kept in a folder and continued by a later run that asks for more.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "bench_scene.h"
#include "path/radiance_sums.h"

namespace lumel::bench {

// What is scored of a texel, summed over the layers: I, then L0 and L1, by colour channel.
inline constexpr std::size_t kScoredSh = 4;
struct TexelLight {
    Vec3 irradiance{};
    std::array<Vec3, kScoredSh> sh{};
};

TexelLight light_of(const RadianceSums& sums, std::size_t texel);

// By texel of the range.
struct ReferenceHalf {
    std::vector<TexelLight> light;
    std::vector<std::uint8_t> valid;
    std::uint64_t samples = 0;
};

struct ReferenceOptions {
    std::filesystem::path folder;
    double minutes = 5.0;  // of each half, over all runs that worked on it; 0: what there is, at least a pass
    std::uint32_t samples = 1 << 16;  // of each half, no more
};

// LUMEL_BENCH_REFERENCES, else a folder below the system's temporary one.
std::filesystem::path default_reference_folder();

// `which`: 0 or 1. The file is named by a hash of the scene and its light, the size of the page and the texels.
ReferenceHalf reference_half(const BenchScene& bench, TexelRange range, std::uint32_t which,
                             const ReferenceOptions& options, Context& context);

}  // namespace lumel::bench
