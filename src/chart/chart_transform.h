// The buffer from which a shader takes the lightmap UVs of instances that share their vertices
// (shaders/chart_transform.*).
//
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018): one transform per instance and chart,
// found by the instance's offset plus the vertex's chart.
#pragma once

#include <vector>

#include "chart/chart_set.h"

namespace lumel {

// Beside Atlas::placements, so that the transform of chart c of instance i is entry first_placement[i] + c: uv = chart
// uv * (x, y) + (z, w), in units of its page. Of charts that lie on no page: in texels.
std::vector<Vec4> chart_transforms(const Atlas& atlas);

}  // namespace lumel
