#include "light/planar.h"

#include <cmath>

#include "math/constants.h"

namespace lumel {

PlanarPatch::PlanarPatch(Vec3 center, Vec3 half_u, Vec3 half_v, Vec3 facing)
    : center_(center), half_u_(half_u), half_v_(half_v) {
    const Vec3 n = cross(half_u, half_v);
    area_ = 4.0 * length(n);
    normal_ = normalize_or(dot(n, facing) < 0.0f ? -n : n, facing);
    const float scale = dot(n, n) > 0.0f ? 1.0f / dot(n, n) : 0.0f;
    s_ = cross(half_v, n) * scale;
    t_ = cross(n, half_u) * scale;
}

LightBounds PlanarPatch::bounds(double power) const {
    LightBounds b;
    for (std::size_t c = 0; c < 3; ++c) {
        const float reach = std::fabs(half_u_[c]) + std::fabs(half_v_[c]);
        b.low[c] = center_[c] - reach;
        b.high[c] = center_[c] + reach;
    }
    b.axis = normal_;
    b.cos_facing = 1.0f;
    b.intensity = power / double{kPi};  // towards the normal, Lambertian
    return b;
}

double PlanarPatch::height(Vec3 point) const {
    // In double: close to the plane the products cancel.
    return (double{point.x} - center_.x) * normal_.x + (double{point.y} - center_.y) * normal_.y +
           (double{point.z} - center_.z) * normal_.z;
}

LightSample PlanarPatch::towards(Vec3 point, Vec2 st, double area) const {
    const double above = height(point);
    if (!(above > 0.0)) return {};
    const Vec3 to_light = (center_ - point) + half_u_ * st.x + half_v_ * st.y;
    const float distance = length(to_light);
    const float pdf = area_to_solid_angle(distance, above / distance, area);
    if (!std::isfinite(pdf) || distance == 0.0f) return {};
    return {to_light / distance, distance, Vec3{1, 1, 1} / pdf, pdf, kNone};
}

PlanarPatch::Crossing PlanarPatch::cross_plane(Vec3 origin, Vec3 direction) const {
    const double above = height(origin);
    const double cosine =
        -(double{direction.x} * normal_.x + double{direction.y} * normal_.y + double{direction.z} * normal_.z);
    if (!(above > 0.0) || !(cosine > 0.0)) return {};
    const double distance = above / cosine;
    if (distance > kInfiniteDistance) return {};
    const Vec3 p = (origin - center_) + direction * static_cast<float>(distance);
    return {{dot(p, s_), dot(p, t_)}, static_cast<float>(distance), static_cast<float>(cosine)};
}

}  // namespace lumel
