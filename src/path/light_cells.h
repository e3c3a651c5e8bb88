// Stage: the surface cells of a scene, lit.
#pragma once

#include "cells/surface_cells.h"
#include "path/path_integrator.h"

namespace lumel {

// Cells for a bake of `path.samples` per texel: their edge is four texels at 256 samples and falls with the square root
// of the count, so that what their steps cost falls with the noise. `transport.cells` must be null.
// Error: cancelled.
Result<SurfaceCells> make_lit_cells(const ChartSet& charts, const Atlas& atlas, const Transport& transport,
                                    const PathOptions& path, Context& context);

}  // namespace lumel
