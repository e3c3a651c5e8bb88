// A page whose numbers are known, without a ray.
#pragma once

#include "post/lightmap.h"

namespace lumel::test {

// One texel in three has no value. Layer l of texel t: I = 10^l * (t + 1) * (1, 2, 3) / 100, the constant and one
// linear coefficient.
inline Lightmap made_up_page(std::uint32_t page, std::uint32_t width, std::uint32_t height) {
    Lightmap map;
    map.page = page;
    map.width = width;
    map.height = height;
    std::uint32_t texels = 0;
    for (std::uint32_t i = 0; i < width * height; ++i) map.texel_at.push_back(i % 3 == 2 ? kNone : texels++);
    map.texels.resize(texels);
    map.coverage.assign(texels, Coverage::baked);
    map.coverage.back() = Coverage::dilated;
    map.surface.albedo.assign(texels, Vec3{0.5f, 0.25f, 1.0f});
    map.surface.emission.assign(texels, Vec3{});
    map.normal.assign(texels, Vec3{0.6f, 0, -0.8f});
    float decade = 0.01f;
    for (std::size_t l = 0; l < kLayerCount; ++l, decade *= 10.0f)
        for (std::uint32_t t = 0; t < texels; ++t) {
            const Vec3 light = Vec3{1, 2, 3} * (decade * float(t + 1));
            LayerMoments& layer = map.texels.layers[t][l];
            layer.irradiance = light;
            layer.sh[0] = light * 3.0f;
            layer.sh[2] = light * 0.7f;
        }
    for (std::uint32_t t = 0; t < texels; ++t) {
        map.texels.count[t] = 60 + t;
        map.texels.ambient_occlusion[t] = 0.5f;
        map.texels.sky_visibility[t] = 0.25f;
        map.texels.bent_normal[t] = {0, 0.5f, 0};
        map.texels.variance[t] = {1, 2, 4};
    }
    return map;
}

}  // namespace lumel::test
