// What every kind of light answers: a direction in which light may arrive, or what a given direction would bring.
#pragma once

#include <cstdint>

#include "lumel/scene.h"

namespace lumel {

inline constexpr float kInfiniteDistance = 1e30f;

// One direction in which light may arrive. Contribution to a vertex with cosine c and BSDF value f, if unoccluded:
// f * c * weight * (pdf > 0 ? mis(pdf, pdf of the BSDF's sampling) : 1).
struct LightSample {
    Vec3 direction{0, 1, 0};  // unit, from the vertex towards the light
    float distance = 0.0f;    // metres to the light; kInfiniteDistance for sun and sky; 0: no sample (weight is zero)
    Vec3 weight{};     // radiance / pdf; for delta lights the irradiance on a facing plane / selection probability
    float pdf = 0.0f;  // per solid angle, selection included; 0 = delta light, cannot be hit by chance
    std::uint32_t triangle = kNone;  // the emissive triangle sampled: shadow rays must not count it as an occluder
    std::uint32_t group = kNone;     // of the local lights, where a table chose it; also where there is no sample
};

// Light met by a ray that was sampled for another reason, and the density with which the sampling above would have
// chosen that direction.
struct LightHit {
    Vec3 radiance{};
    float pdf = 0.0f;
    float distance = kInfiniteDistance;
};

// Mean of the channels: how much of the error of a colour image a light can cause. Luminance would starve blue lights.
// Finite for all that validate() lets through (kMaxRadiance).
constexpr float strength(Vec3 color) { return (color.x + color.y + color.z) * (1.0f / 3.0f); }

}  // namespace lumel
