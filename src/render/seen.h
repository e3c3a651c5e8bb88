// Which surface each pixel of a camera view sees: what is drawn there is up to others.
#pragma once

#include <cstdint>
#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "scene/world_geometry.h"
#include "trace/tracer.h"

namespace lumel {

struct SeenSurfaces {
    std::uint32_t width = 0, height = 0;
    std::vector<Hit> hits;      // row by row, through the centres of the pixels
    std::vector<float> facing;  // cosine of the angle between ray and face, 0..1; 0 where there is no surface
};

// `through_backs`: single-sided surfaces are not seen from behind, as in a viewer; else their backs are what is seen.
// Error: cancelled.
Result<SeenSurfaces> see_surfaces(const Tracer& tracer, const WorldGeometry& geometry, const Camera& camera,
                                  std::uint32_t width, std::uint32_t height, bool through_backs, Context& context);

}  // namespace lumel
