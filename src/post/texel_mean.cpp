#include "post/texel_mean.h"

#include <algorithm>

namespace lumel {

void TexelMean::add(std::uint32_t texel) {
    const RadianceSums& from = page_.texels;
    ++n_;
    for (std::size_t l = 0; l < kLayerCount; ++l) {
        for (std::size_t k = 0; k < kShCoefficients; ++k) layers_[l].sh[k] += from.layers[texel][l].sh[k];
        layers_[l].irradiance += from.layers[texel][l].irradiance;
    }
    variance_ += from.variance[texel];
    difference_ += from.half_difference[texel];
    bent_ += from.bent_normal[texel];
    sky_ += from.sky_visibility[texel];
    occlusion_ += from.ambient_occlusion[texel];
    count_ += from.count[texel];
    open_ += from.open[texel];
    albedo_ += page_.surface.albedo[texel];
    emission_ += page_.surface.emission[texel];
    normal_ += page_.normal[texel];
    any_normal_ = page_.normal[texel];
    coverage_ = std::max(coverage_, page_.coverage[texel]);
}

void TexelMean::store_light(RadianceSums& to, std::size_t texel) const {
    const float s = 1.0f / static_cast<float>(n_);
    for (std::size_t l = 0; l < kLayerCount; ++l) {
        for (std::size_t k = 0; k < kShCoefficients; ++k) to.layers[texel][l].sh[k] = layers_[l].sh[k] * s;
        to.layers[texel][l].irradiance = layers_[l].irradiance * s;
    }
    to.variance[texel] = variance_ * s;
    to.bent_normal[texel] = bent_ * s;
    to.sky_visibility[texel] = sky_ * s;
    to.ambient_occlusion[texel] = occlusion_ * s;
}

void TexelMean::store_surface(Lightmap& to, std::size_t texel) const {
    const float s = 1.0f / static_cast<float>(n_);
    to.surface.albedo[texel] = albedo_ * s;
    to.surface.emission[texel] = emission_ * s;
    to.normal[texel] = normalize_or(normal_, any_normal_);  // of a sheet and its back they cancel
}

void TexelMean::store(Lightmap& to, std::size_t texel, std::uint32_t chart) const {
    store_light(to.texels, texel);
    store_surface(to, texel);
    const float s = 1.0f / static_cast<float>(n_);
    to.texels.variance[texel] = variance_ * (s * s);
    to.texels.half_difference[texel] = difference_ * s;
    constexpr std::uint64_t kMost = 0xffffffffu;
    to.texels.count[texel] = static_cast<std::uint32_t>(std::min(count_, kMost));
    to.texels.open[texel] = static_cast<std::uint32_t>(std::min(open_, kMost));
    to.coverage[texel] = coverage_;
    to.chart[texel] = chart;
}

void copy_texel(const Lightmap& from, std::size_t texel, Lightmap& to, std::size_t at) {
    to.texels.layers[at] = from.texels.layers[texel];
    to.texels.variance[at] = from.texels.variance[texel];
    to.texels.half_difference[at] = from.texels.half_difference[texel];
    to.texels.bent_normal[at] = from.texels.bent_normal[texel];
    to.texels.sky_visibility[at] = from.texels.sky_visibility[texel];
    to.texels.ambient_occlusion[at] = from.texels.ambient_occlusion[texel];
    to.texels.count[at] = from.texels.count[texel];
    to.texels.open[at] = from.texels.open[texel];
    to.surface.albedo[at] = from.surface.albedo[texel];
    to.surface.emission[at] = from.surface.emission[texel];
    to.normal[at] = from.normal[texel];
    to.coverage[at] = from.coverage[texel];
    to.chart[at] = from.chart[texel];
    if (at < to.leaks.size() && texel < from.leaks.size()) to.leaks[at] = from.leaks[texel];
}

void resize_texels(Lightmap& map, std::size_t texels) {
    map.texels.resize(texels);
    map.surface.albedo.resize(texels);
    map.surface.emission.resize(texels);
    map.normal.resize(texels);
    map.coverage.resize(texels, Coverage::none);
    map.chart.resize(texels, kNone);
}

}  // namespace lumel
