// Smooths the noise of a page: non-local means over texels that are neighbours by chart, plane, normal and distance.
#pragma once

#include <array>
#include <cstdint>

#include "lumel/context.h"
#include "lumel/result.h"
#include "path/radiance_sums.h"
#include "texel/texel_buffer.h"

namespace lumel {

struct DenoiseOptions {
    std::uint32_t radius = 7;  // of the window, in texels
    float strength = 0.5f;     // k of Rousselle et al.: noise beyond it counts as a feature
    std::array<bool, kLayerCount> included{true, true, true};  // layers that the variance is of
};

// Replaces the layers of each valid texel by a weighted mean over its window: one weight per neighbour for all layers
// and coefficients, so that SH vectors that are valid stay valid. Neighbours are valid texels of the same chart
// whose normals are within 30 degrees, which lie within half a texel of each other's tangent planes, and which are at
// most 1.8 times as far apart in the world as in texels. Weights compare 3x3 patches
// of the irradiance of the included layers, relative to the variance that the page states. Variance, counts, sky
// visibility and occlusion stay as they were sampled. Any number of threads gives the same bits. Error: cancelled.
Status denoise(const TexelBuffer& texels, const DenoiseOptions& options, RadianceSums& sums, Context& context);

}  // namespace lumel
