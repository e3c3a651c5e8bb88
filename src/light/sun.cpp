#include "light/sun.h"

#include <algorithm>
#include <numbers>

#include "math/constants.h"
#include "math/warp.h"

namespace lumel {

SunLight::SunLight(const Light& light) : frame_(-light.direction), irradiance_(light.intensity) {
    if (light.angular_diameter <= 0.0f) return;
    const double half = std::min(0.5 * static_cast<double>(light.angular_diameter), 0.5 * std::numbers::pi);
    const double sine = sincos_radians(half).sine, half_sine = sincos_radians(0.5 * half).sine;
    one_minus_cos_ = static_cast<float>(2.0 * half_sine * half_sine);
    sine_squared_ = static_cast<float>(sine * sine);
    // The integral of cos over the disc, facing its centre, is pi sin^2.
    radiance_ = irradiance_ * (kInvPi / sine_squared_);
}

LightSample SunLight::sample(Vec2 u) const {
    if (one_minus_cos_ == 0.0f) return {frame_.normal, kInfiniteDistance, irradiance_, 0.0f, kNone};
    const float pdf = UniformCone::pdf(one_minus_cos_);
    const Vec3 direction = frame_.to_world(UniformCone::sample(u, one_minus_cos_));
    return {direction, kInfiniteDistance, radiance_ / pdf, pdf, kNone};
}

LightHit SunLight::intersect(Vec3 direction) const {
    // By the sine: the cosine of a small disc's edge has too few digits.
    const Vec3 across = cross(direction, frame_.normal);
    const bool inside = dot(direction, frame_.normal) > 0.0f && dot(across, across) <= sine_squared_;
    if (one_minus_cos_ == 0.0f || !inside) return {};
    return {radiance_, UniformCone::pdf(one_minus_cos_), kInfiniteDistance};
}

}  // namespace lumel
