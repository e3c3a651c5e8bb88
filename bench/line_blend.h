// The published way to hide seams without a solver, as the baseline: the other side's light is drawn over the texels of
// a seam, again and again.
// Based on: "Baking artifact-free lightmaps on the GPU" (Bakery, 2018), "Fixing UV seams"; Godot's lm_blendseams does
// the same. Edges of one mesh alone, whose both ends meet; no T-junctions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "check/checked_bake.h"
#include "seam/find_seams.h"

namespace lumel::bench {

// `triangle_instance`: per world triangle. Each pass draws every seam once from each side, half transparent, from what
// the pass before left.
void blend_lines(std::span<const BorderEdge> edges, std::span<const Seam> seams,
                 std::span<const std::uint32_t> triangle_instance, std::uint32_t passes, std::vector<Image>& pages);

}  // namespace lumel::bench
