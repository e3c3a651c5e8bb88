// Smooths the noise of a page: non-local means over texels that are neighbours on the surface too.
#pragma once

#include "lumel/context.h"
#include "lumel/result.h"
#include "path/radiance_sums.h"
#include "texel/texel_buffer.h"

namespace lumel {

struct DenoiseOptions {
    std::uint32_t radius = 7;  // of the window, in texels
    float strength = 0.5f;     // k of Rousselle et al.: noise beyond it counts as a feature
};

// Replaces the layers of each valid texel by a weighted mean over its window: one weight per neighbour for all layers
// and coefficients, so that SH vectors that are valid stay valid. Neighbours are texels that a walk over the surface
// reaches: normals within 30 degrees, and as far apart in the world as they are in texels. Weights compare 3x3 patches
// of the total irradiance, relative to the variance that the page states. Variance, counts, sky visibility and
// occlusion stay as they were sampled. Any number of threads gives the same bits. Error: cancelled.
Status denoise(const TexelBuffer& texels, const DenoiseOptions& options, RadianceSums& sums, Context& context);

}  // namespace lumel
