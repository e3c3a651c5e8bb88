// The variance of each texel's mean, as its neighbourhood shows it. Samples that are spread evenly err less than the
// variance among them says (by 1.3 to 3 times in the benchmark's scenes), by how much depends on the light: that is
// measured.
#pragma once

#include "lumel/context.h"
#include "lumel/result.h"
#include "path/radiance_sums.h"
#include "texel/texel_buffer.h"

namespace lumel {

// Replaces `variance`, the estimate for independent samples, by one that holds: an interval of +-1.96 deviations about
// the irradiance contains the truth for 95 of 100 texels (without the noise that cells put into many texels alike). Two
// halves of a texel's samples are spread evenly each for itself; a quarter of their squared difference is what the mean
// of both errs, an unbiased but very rough estimate. Over the texels around (7 x 7, of the same chart, normals within
// 30 degrees) its sum over the sum of the variances for independent samples says what share of these is true. Texels of
// one sample keep theirs. Scratch memory: a Vec3 per texel. Any number of threads gives the same bits. Error:
// cancelled.
Status pool_variance(const TexelBuffer& texels, RadianceSums& sums, Context& context);

}  // namespace lumel
