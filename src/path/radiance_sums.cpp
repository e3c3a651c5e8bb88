#include "path/radiance_sums.h"

namespace lumel {

void RadianceSums::reserve(std::size_t texels) {
    layers.reserve(texels);
    variance.reserve(texels);
    half_difference.reserve(texels);
    sky_visibility.reserve(texels);
    ambient_occlusion.reserve(texels);
    bent_normal.reserve(texels);
    count.reserve(texels);
    open.reserve(texels);
}

void RadianceSums::resize(std::size_t texels) {
    layers.resize(texels);
    variance.resize(texels);
    half_difference.resize(texels);
    sky_visibility.resize(texels);
    ambient_occlusion.resize(texels);
    bent_normal.resize(texels);
    count.resize(texels);
    open.resize(texels);
}

void RadianceSums::clear(std::size_t texel) {
    layers[texel] = {};
    variance[texel] = half_difference[texel] = bent_normal[texel] = {};
    sky_visibility[texel] = ambient_occlusion[texel] = 0.0f;
    count[texel] = open[texel] = 0;
}

}  // namespace lumel
