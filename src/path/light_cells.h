// Stage: the surface cells of a scene, lit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cells/surface_cells.h"
#include "path/path_integrator.h"

namespace lumel {

// Edge of the cells of a bake in texels of its atlas, for so many samples per texel: 2.8 at 256, falling with the
// square root of the count, so that what their steps cost falls with the noise; larger where there would be more than
// kMostCells.
double texels_per_cell(const Atlas& atlas, std::uint32_t samples);

// A bound of their memory: the links of so many take 0.4 GB. Scenes of tiny charts, of four cells each, can pass it.
inline constexpr double kMostCells = 400000.0;
// Links of a cell: fewer where there are many cells, and in bakes of few samples per texel, whose own noise hides that
// of the cells (scenes of tiny charts have as many cells as ever, and spent most of a quick bake on them).
inline constexpr std::size_t kLinksPerCell = 128, kFewestLinksPerCell = 64, kFewestLinksOfFewSamples = 32;
inline constexpr std::size_t kMostLinks = std::size_t{1} << 25;
inline std::size_t links_per_cell(std::size_t cells, std::uint32_t samples) {
    const std::size_t by_samples = std::clamp(2 * std::size_t{samples}, kFewestLinksOfFewSamples, kLinksPerCell);
    return std::min(by_samples,
                    std::clamp(kMostLinks / std::max<std::size_t>(1, cells), kFewestLinksPerCell, kLinksPerCell));
}

// Cells for a bake of `path.samples` per texel, at least one bounce. `path.bounces` bounds the links of a chain; what a
// cell's own paths pass before they end at the next (near hits, surfaces without cells) comes on top.
// Error: cancelled.
Result<SurfaceCells> make_lit_cells(const ChartSet& charts, const Atlas& atlas, const Transport& transport,
                                    const PathOptions& path, Context& context);

}  // namespace lumel
