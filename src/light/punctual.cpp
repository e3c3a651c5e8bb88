#include "light/punctual.h"

#include <algorithm>
#include <cmath>

#include "math/constants.h"
#include "math/trig.h"

namespace lumel {

PunctualLight::PunctualLight(const Light& light)
    : sphere_{light.position, light.radius},
      intensity_(light.intensity),
      axis_(light.direction),
      range_(light.range),
      spot_(light.shape == LightShape::spot) {
    // Its projected disc of area pi r^2 has the intensity.
    if (light.radius > 0.0f) radiance_ = intensity_ * (kInvPi / light.radius / light.radius);
    if (!spot_) return;
    const auto inner = static_cast<float>(sincos_radians(light.inner_cone).cosine);
    const auto outer = static_cast<float>(sincos_radians(light.outer_cone).cosine);
    cone_scale_ = 1.0f / std::max(0.001f, inner - outer);
    cone_offset_ = -outer * cone_scale_;
    // The squared ramp between the cones passes a third of what it would at full strength.
    cos_inner_ = inner;
    cos_ramp_ = static_cast<float>(sincos_radians(std::max(0.0f, light.outer_cone - light.inner_cone)).cosine);
    lit_share_ = 0.5f * (1.0f - inner) + (inner - outer) / 6.0f;
}

double PunctualLight::power() const { return 4.0 * kPi * lit_share_ * strength(intensity_); }

LightBounds PunctualLight::bounds() const {
    LightBounds b;
    const Vec3 r{sphere_.radius, sphere_.radius, sphere_.radius};
    b.low = sphere_.center - r;
    b.high = sphere_.center + r;
    b.axis = axis_;
    b.cos_facing = spot_ ? cos_inner_ : -1.0f;
    // A hair wider than the cone, against its rim being cut off by rounding.
    b.cos_emission = spot_ ? cos_ramp_ - 1e-5f : 0.0f;
    b.intensity = strength(intensity_);
    if (range_ > 0.0f) b.reach = range_ * 1.0001f;
    b.must_be_sampled = !can_be_hit();
    return b;
}

float PunctualLight::attenuation(Vec3 point) const {
    const Vec3 from_light = point - sphere_.center;
    float factor = 1.0f;
    if (range_ > 0.0f) {
        const float ratio = dot(from_light, from_light) / (range_ * range_);
        factor = std::clamp(1.0f - ratio * ratio, 0.0f, 1.0f);
    }
    if (spot_) {
        const float cosine = dot(normalize_or(from_light, axis_), axis_);
        const float ramp = std::clamp(cosine * cone_scale_ + cone_offset_, 0.0f, 1.0f);
        factor *= ramp * ramp;
    }
    return factor;
}

LightSample PunctualLight::sample_point(Vec3 point) const {
    constexpr float kTooClose = 1e-6f;  // metres: the inverse square would overflow, and direction means nothing
    const Vec3 to_light = sphere_.center - point;
    const float distance = length(to_light);
    if (distance < kTooClose) return {};
    return {to_light / distance, distance, intensity_ * (1.0f / distance / distance), 0.0f, kNone};
}

LightSample PunctualLight::sample(Vec3 point, Vec2 u) const {
    const float factor = attenuation(point);
    if (factor == 0.0f) return {};
    LightSample sample = can_be_hit() ? sample_sphere(sphere_, point, u) : sample_point(point);
    sample.weight *= can_be_hit() ? radiance_ * factor : Vec3{factor, factor, factor};
    return sample;
}

LightHit PunctualLight::intersect(Vec3 origin, Vec3 direction) const {
    LightHit hit = intersect_sphere(sphere_, origin, direction);
    hit.radiance *= radiance_ * attenuation(origin);
    return hit;
}

}  // namespace lumel
