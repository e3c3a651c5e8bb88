// Plain irradiance, and the sum over layers that every encoding starts from.
#pragma once

#include <array>
#include <cstddef>

#include "lumel/options.h"
#include "sh/coefficients.h"

namespace lumel {

// How much of each layer a file holds, in the order direct, sky, indirect. The artist's direct_scale and indirect_scale
// are in the layers already.
using LayerWeights = std::array<float, 3>;

constexpr LayerWeights layer_weights(const Include& include) {
    return {include.direct ? 1.0f : 0.0f, include.sky ? 1.0f : 0.0f, include.indirect ? 1.0f : 0.0f};
}

// Sum over layers of weight * value(layer). A layer of weight 0 is not read: what is excluded cannot leak in as 0 *
// inf.
template <class ValueOf>
constexpr Vec3 sum_layers(const LayerWeights& weights, ValueOf&& value) {
    Vec3 sum{};
    for (std::size_t layer = 0; layer < weights.size(); ++layer)
        if (weights[layer] != 0.0f) sum += value(layer) * weights[layer];
    return sum;
}

// `sh_of(layer)` gives the layer's nine coefficients.
template <class ShOf>
constexpr RadianceSh<Vec3, 9> sum_sh_layers(const LayerWeights& weights, ShOf&& sh_of) {
    RadianceSh<Vec3, 9> sum;
    for (std::size_t i = 0; i < 9; ++i)
        sum.c[i] = sum_layers(weights, [&](std::size_t layer) { return sh_of(layer)[i]; });
    return sum;
}

// I = E/pi in direction n from the quadratic moments. Truncated: for the vertex normal use the sampled scalar instead.
constexpr Vec3 irradiance_from_sh(const RadianceSh<Vec3, 9>& radiance, Vec3 n) {
    return evaluate(convolve_cosine(radiance), n);
}

}  // namespace lumel
