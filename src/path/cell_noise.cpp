#include "path/cell_noise.h"

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "cells/surface_cells.h"

namespace lumel {

Status add_cell_noise(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas, const Transport& transport,
                      const PathOptions& options, RadianceSums& sums, Context& context) {
    LUMEL_CHECK(transport.cells && sums.size() >= texels.size(), sums.size(), texels.size());
    constexpr auto kIndirect = static_cast<std::size_t>(Layer::indirect);
    if (!options.included[kIndirect]) return success();
    const SurfaceCells& cells = *transport.cells;
    const float scale = options.layer_scale[kIndirect];
    const bool done = parallel_for(context, texels.size(), 1024, [&](const ChunkRange& range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const auto [triangle, b1, b2] =
                representative_point(texels, i, transport.scene, transport.geometry, charts, atlas);
            const SurfaceCells::Place place = cells.find(triangle, b1, b2, false);
            if (place.home != kNone) {
                sums.variance[i] += cells.noise(place) * (scale * scale);
                continue;
            }
            const Vec3 light = sums.layers[i][kIndirect].irradiance;  // scaled already
            sums.variance[i] += cells.relative_noise() * light * light;
        }
    });
    return done ? success() : Status(cancelled_error());
}

}  // namespace lumel
