// What rectangle and disc share: a flat patch spanned by two half axes, lit on one side.
#pragma once

#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "lumel/vec.h"

namespace lumel {

class PlanarPatch {
public:
    // `facing` decides the lit side; it need not be exactly perpendicular.
    PlanarPatch(Vec3 center, Vec3 half_u, Vec3 half_v, Vec3 facing);

    // Area of the parallelogram (-1..1)^2.
    [[nodiscard]] double area() const { return area_; }
    // Of a light of that power that fills the patch or a part of it.
    [[nodiscard]] LightBounds bounds(double power) const;
    [[nodiscard]] Vec3 half_u() const { return half_u_; }
    [[nodiscard]] Vec3 half_v() const { return half_v_; }
    [[nodiscard]] Vec3 normal() const { return normal_; }
    // Distance of the point from the plane, positive on the lit side.
    [[nodiscard]] double height(Vec3 point) const;
    // The light sample towards the position (s, t) of the patch, without a radiance: weight is 1/pdf, and the density
    // that of a uniform choice from `area` square metres.
    [[nodiscard]] LightSample towards(Vec3 point, Vec2 st, double area) const;

    struct Crossing {
        Vec2 st{};
        float distance = 0.0f;  // 0: none
        float cosine = 0.0f;    // at the light
    };
    // Where a ray meets the plane from its lit side.
    [[nodiscard]] Crossing cross_plane(Vec3 origin, Vec3 direction) const;

    [[nodiscard]] Vec3 center() const { return center_; }

private:
    Vec3 center_, half_u_, half_v_, normal_;
    Vec3 s_, t_;  // the dual basis: s = dot(p - center, s_)
    double area_;
};

// Solid-angle density of a uniform choice from `area` square metres, seen from a distance at a cosine.
inline float area_to_solid_angle(double distance, double cosine, double area) {
    return static_cast<float>(distance * distance / (cosine * area));
}

}  // namespace lumel
