// Chooses the values of texels so that what bilinear lookups show is the light that was gathered.
#pragma once

#include "lumel/context.h"
#include "lumel/result.h"
#include "post/lightmap.h"
#include "texel/texel_buffer.h"

namespace lumel {

struct FitOptions {
    float damping = 0.1f;  // of corrections, against equations of weight 1: keeps rims that nothing holds still
    std::uint32_t iterations = 16;  // of the conjugate gradients
    float least = 0.25f, most = 2;  // what a texel's light may be multiplied by
};

// A texel gathers from its points and holds their mean, but a lookup at those points blends it with its neighbours. On
// the rim of a chart, where texel centres lie on the border and all points beside them, even light that rises evenly
// comes out wrong: a chart of two texels shows half of its contrast. The fit finds the values whose blends come nearest
// to the means, layer by layer; texels of the rings around a chart, which lookups read, are chosen with the others.
//
// `map`: of finish_page() for `buffer`. Irradiance is replaced; spherical harmonics are scaled with it, so that vectors
// that are valid stay so. What is black stays black. Variance, counts, sky visibility and occlusion stay as sampled.
// Noise is sharpened with all the rest: meant for light that was denoised. Runs on one thread. Error: cancelled.
Status fit_to_lookup(const TexelBuffer& buffer, const FitOptions& options, Lightmap& map, Context& context);

}  // namespace lumel
