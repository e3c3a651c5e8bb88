// read_pixels: the pixels of a finished page, layers summed.
#include "lumel/page.h"

#include "encode/irradiance.h"
#include "post/lightmap.h"

namespace lumel {

PagePixels read_pixels(const Lightmap& lightmap, const Include& include) {
    const LayerWeights weights = layer_weights(include);
    PagePixels out{lightmap.page, lightmap.mip, lightmap.width, lightmap.height, {}, {}};
    out.irradiance.resize(lightmap.texel_at.size());
    out.coverage.resize(lightmap.texel_at.size(), Coverage::none);
    for (std::size_t i = 0; i < lightmap.texel_at.size(); ++i) {
        const std::uint32_t t = lightmap.texel_at[i];
        if (t == kNone) continue;
        const auto& layers = lightmap.texels.layers[t];
        out.irradiance[i] = sum_layers(weights, [&](std::size_t l) { return layers[l].irradiance; });
        out.coverage[i] = lightmap.coverage[t];
    }
    return out;
}

}  // namespace lumel
