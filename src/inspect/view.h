// A layer through a camera: what each pixel looks up, as a renderer would.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "inspect/layer.h"
#include "render/seen.h"

namespace lumel {

enum class ViewFilter : std::uint8_t { point, bilinear, bicubic };

// What a pixel shows.
enum class Shown : std::uint8_t {
    texel,        // the number that it looks up
    empty,        // its lookup meets no texel that has one
    no_lightmap,  // a surface without texels
    back,         // of a single-sided surface
    nothing,      // no surface
};

struct LayerView {
    Image values;               // a channel for each of the layer; zero where no texel is shown
    std::vector<Shown> shown;   // per pixel
    std::vector<float> facing;  // SeenSurfaces::facing
};

// Layers whose numbers do not blend are looked up at a point, whatever the filter. TexelLayer::is_looked_up: texels
// without a number count as zero, as they do for a renderer.
LayerView look_up(const TexelLayer& layer, std::span<const LayerPage> pages, const Scene& scene,
                  const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas, const SeenSurfaces& seen,
                  ViewFilter filter);

}  // namespace lumel
