// Where the paths of each texel start, without tracing them: for those who want to see what a bake does with its
// texels.
#pragma once

#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"
#include "path/path_integrator.h"
#include "texel/texel_buffer.h"

namespace lumel {

// Indexed like the TexelBuffer.
struct TexelStarts {
    std::vector<StartsPlace> place;
    // Share of a texel's usual points (0..1) that start from their flat facet although their triangle is smooth-shaded:
    // something lies between it and the smooth position.
    std::vector<float> flat_share;
};

// `options`: those of the bake; seed and samples decide what is looked at. Stage "starts". Error: cancelled.
Result<TexelStarts> find_texel_starts(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                                      const Transport& transport, const PathOptions& options, Context& context);

}  // namespace lumel
