// Lightmap UVs from the baked geometry to the displayed one. Today both are one mesh, and the lift is the identity
// corner by corner; proxies and levels of detail will bring a projection.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"

namespace lumel {

// Per triangle of the displayed instance's mesh: its corners in texels, and their page. Empty where the instance has no
// lightmap. Checks that the displayed mesh is the baked one, the very object: anything else is not ours to guess.
std::vector<Atlas::TriangleUv> lift(const Scene& scene, const ChartSet& charts, const Atlas& atlas,
                                    std::uint32_t display_instance);

}  // namespace lumel
