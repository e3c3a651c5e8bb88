// The g-buffer of a bake as layers: what it knows of each texel before any light. By the functions that the bake itself
// calls; nothing here is computed in another way.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "inspect/layer.h"
#include "lumel/context.h"
#include "lumel/page.h"
#include "path/path_integrator.h"
#include "path/texel_starts.h"
#include "texel/texel_buffer.h"
#include "texel/texel_surface.h"

namespace lumel {

// What the layers need beside the texels.
struct GBufferNeeds {
    bool surface = false, starts = false;
};

struct GBufferPage {
    TexelBuffer texels;
    TexelSurface surface;  // empty unless needed
    TexelStarts starts;
};

// What a layout was baked from. Borrowed.
struct BakedLayout {
    const ChartSet& charts;
    const Atlas& atlas;
    const Transport& transport;
};

// All pages at once: some 100 bytes per covered texel. Stages "texels", "starts". Error: cancelled.
Result<std::vector<GBufferPage>> make_gbuffer(const BakedLayout& layout, const PathOptions& options,
                                              const GBufferNeeds& needs, Context& context);

// The layers there are, in the order in which they are listed.
std::span<const TexelLayer> gbuffer_layers();
GBufferNeeds needs_of(const TexelLayer& layer);

// `coverage`: per pixel, of the master. Layers but "state" and "coverage" do not read it.
LayerPage gbuffer_layer(const TexelLayer& layer, const BakedLayout& layout, const GBufferPage& page,
                        std::span<const Coverage> coverage);

}  // namespace lumel
