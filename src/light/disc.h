// A disc or ellipse of uniform radiance, lit on one side, sampled by area.
#pragma once

#include "light/planar.h"

namespace lumel {

class DiscLight {
public:
    explicit DiscLight(const Light& light);

    [[nodiscard]] double power() const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] bool can_be_hit() const { return true; }
    [[nodiscard]] LightSample sample(Vec3 point, Vec2 u) const;
    [[nodiscard]] LightHit intersect(Vec3 origin, Vec3 direction) const;

private:
    PlanarPatch patch_;
    double area_;
    Vec3 radiance_;
};

}  // namespace lumel
