// Point and spot lights of KHR_lights_punctual, in candela. With a radius they are spheres that look the same from
// afar. Based on: the glTF extension KHR_lights_punctual (range window, spot cone).
#pragma once

#include "light/light_sample.h"
#include "light/sphere.h"

namespace lumel {

class PunctualLight {
public:
    explicit PunctualLight(const Light& light);

    [[nodiscard]] double power() const;
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
    float lit_share_ = 1.0f;  // of all directions
};

}  // namespace lumel
