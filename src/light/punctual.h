// Point and spot lights of KHR_lights_punctual, in candela. With a radius they are spheres that look the same from
// afar. Based on: the glTF extension KHR_lights_punctual (range window, spot cone).
#pragma once

#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "light/sphere.h"

namespace lumel {

class PunctualLight {
public:
    explicit PunctualLight(const Light& light);

    [[nodiscard]] double power() const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] bool can_be_hit() const { return sphere_.radius > 0.0f; }
    [[nodiscard]] LightSample sample(Vec3 point, Vec2 u) const;
    [[nodiscard]] LightHit intersect(Vec3 origin, Vec3 direction) const;

private:
    // The range window and the spot's cone, seen from the light's centre.
    [[nodiscard]] float attenuation(Vec3 point) const;
    [[nodiscard]] LightSample sample_point(Vec3 point) const;

    Sphere sphere_;
    Vec3 intensity_;
    Vec3 radiance_{};  // of the sphere, where there is one
    Vec3 axis_;
    float range_;
    bool spot_;
    float cone_scale_ = 0.0f, cone_offset_ = 1.0f;
    float lit_share_ = 1.0f;                     // of all directions
    float cos_inner_ = -1.0f, cos_ramp_ = 1.0f;  // of the inner cone, and of the angle from it to the outer one
};

}  // namespace lumel
