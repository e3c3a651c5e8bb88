// What the surface of each texel reflects and emits: the mean over its sample points.
#pragma once

#include <vector>

#include "scene/surface.h"
#include "texel/texel_buffer.h"

namespace lumel {

// Indexed like the TexelBuffer.
struct TexelSurface {
    std::vector<Vec3> albedo;
    std::vector<Vec3> emission;  // nits, of the front face
};

// Error: cancelled.
Result<TexelSurface> read_texel_surface(const TexelBuffer& texels, const Scene& scene, const WorldGeometry& geometry,
                                        const ChartSet& charts, const Atlas& atlas, Context& context);

}  // namespace lumel
