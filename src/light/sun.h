// A directional light. Its intensity is the irradiance on a plane facing it (lux), whatever its angular size.
#pragma once

#include "light/light_sample.h"
#include "math/frame.h"

namespace lumel {

class SunLight {
public:
    explicit SunLight(const Light& light);

    [[nodiscard]] LightSample sample(Vec2 u) const;
    [[nodiscard]] LightHit intersect(Vec3 direction) const;
    [[nodiscard]] bool has_size() const { return one_minus_cos_ > 0.0f; }

private:
    Frame frame_;  // its normal: the unit direction to the centre of the disc
    Vec3 irradiance_;
    Vec3 radiance_{};             // of the disc
    float one_minus_cos_ = 0.0f;  // of its half angle; 0 = a point
    float sine_squared_ = 0.0f;
};

}  // namespace lumel
