#include "light/disc.h"

#include "math/constants.h"
#include "math/warp.h"

namespace lumel {

DiscLight::DiscLight(const Light& light)
    : patch_(light.position, light.half_u, light.half_v, light.direction),
      area_(0.25 * kPi * patch_.area()),
      radiance_(light.intensity) {}

double DiscLight::power() const { return double{kPi} * area_ * strength(radiance_); }

LightBounds DiscLight::bounds() const { return patch_.bounds(power()); }

LightSample DiscLight::sample(Vec3 point, Vec2 u) const {
    LightSample sample = patch_.towards(point, ConcentricDisc::sample(u), area_);
    sample.weight *= radiance_;
    return sample;
}

LightHit DiscLight::intersect(Vec3 origin, Vec3 direction) const {
    const PlanarPatch::Crossing c = patch_.cross_plane(origin, direction);
    if (c.distance == 0.0f || dot(c.st, c.st) > 1.0f) return {};
    return {radiance_, area_to_solid_angle(c.distance, c.cosine, area_), c.distance};
}

}  // namespace lumel
