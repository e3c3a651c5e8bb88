// A highlight from the linear band: how rough the surface must look for light that comes from a wide lobe to be shown
// as one direction. Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (direction and strength of
// L1 as a light). Different here: roughness by adding variances: the lobe as a von Mises-Fisher one of sharpness k,
// alpha'^2 = alpha^2 + 1/k.
#pragma once

#include <algorithm>
#include <cmath>

namespace lumel {

// GGX alpha for light whose normalised linear band has length r: 0 all around, 1 a single direction.
inline float widened_alpha(float alpha, float r) {
    if (!(r > 0.0f)) return 1.0f;
    const float s = std::min(r, 1.0f), inverse_sharpness = (1.0f - s * s) / (s * (3.0f - s * s));
    return std::min(std::sqrt(alpha * alpha + inverse_sharpness), 1.0f);
}

// The talk's own heuristic.
inline float adjusted_smoothness(float smoothness, float r) {
    return smoothness * std::sqrt(std::clamp(r, 0.0f, 1.0f));
}

}  // namespace lumel
