// A sphere of uniform radiance, sampled by the cone it fills. From inside it glows all around.
// Based on: Shirley, Wang, Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations".
#pragma once

#include "light/light_bounds.h"
#include "light/light_sample.h"

namespace lumel {

struct Sphere {
    Vec3 center;
    float radius;
};
// Without a radiance (weight 1/pdf): lights multiply their own.
LightSample sample_sphere(const Sphere& sphere, Vec3 point, Vec2 u);
LightHit intersect_sphere(const Sphere& sphere, Vec3 origin, Vec3 direction);

class SphereLight {
public:
    explicit SphereLight(const Light& light) : sphere_{light.position, light.radius}, radiance_(light.intensity) {}

    [[nodiscard]] double power() const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] bool can_be_hit() const { return true; }
    [[nodiscard]] LightSample sample(Vec3 point, Vec2 u) const;
    [[nodiscard]] LightHit intersect(Vec3 origin, Vec3 direction) const;

private:
    Sphere sphere_;
    Vec3 radiance_;
};

}  // namespace lumel
