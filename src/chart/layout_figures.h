// How good a layout is, in figures: how much of the pages it uses, how dense its texels are and how charts are
// stretched.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_picture.h"
#include "chart/chart_set.h"

namespace lumel {

struct PageFigures {
    std::uint64_t used = 0, covered = 0;  // texels that lookups touch; of these, those that are baked
    double efficiency = 0.0;              // used over all texels of the page
};
PageFigures page_figures(const TexelOwners& owners);

// Texels of each mip that Atlas::masks declares, the page itself first: those that lookups touch, over all of them.
struct MipFigures {
    std::uint64_t used = 0, texels = 0;

    [[nodiscard]] double efficiency() const {
        return texels > 0 ? static_cast<double>(used) / static_cast<double>(texels) : 0.0;
    }
};
std::vector<MipFigures> mip_figures(const Scene& scene, const ChartSet& charts, const Atlas& atlas, std::uint32_t page);

// Texels per metre at every triangle of the world: the root of its area on the page over that in the world. 0 where it
// has no texels, or no area.
std::vector<double> triangle_densities(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                       const Atlas& atlas);

// Sander's L2 stretch (2001) of every triangle by itself, in its chart: 1 where its shape is kept, whatever its size.
// Infinite where it has lost its area. Per mesh; empty for meshes without charts.
std::vector<std::vector<double>> triangle_stretches(const Scene& scene, const ChartSet& charts);

// L2 stretch of the charts, before they are fitted to texels: the mean of the squares over the surface that gets
// texels, its root; triangles without area in UV are left out. 1: no stretch at all, or no charts.
double layout_stretch(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts);

// Mean over the area of what has texels: the root of texels over square metres. For layouts that were kept, too.
double mean_density(const WorldGeometry& geometry, const std::vector<double>& triangle_densities);

}  // namespace lumel
