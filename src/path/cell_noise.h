// The noise that surface cells put into what is gathered from them.
#pragma once

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "path/path_integrator.h"
#include "path/radiance_sums.h"
#include "texel/texel_buffer.h"

namespace lumel {

// Adds it to `variance`, which is else of a texel's own samples: the paths of the cells are few where those of texels
// are many, and their noise is common to many texels. After pool_variance() and whatever smooths by the variance, for
// which that noise looks like light. Needs transport.cells; nothing changes where the indirect layer is left out.
// Error: cancelled.
Status add_cell_noise(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas, const Transport& transport,
                      const PathOptions& options, RadianceSums& sums, Context& context);

}  // namespace lumel
