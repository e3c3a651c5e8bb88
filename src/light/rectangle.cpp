#include "light/rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/constants.h"
#include "math/trig.h"

namespace lumel {
namespace {

// Steradians. Below it the directions hardly differ, and sampling by area has the same noise with fewer operations that
// cancel.
constexpr double kSmallSolidAngle = 1e-4;
constexpr double kTwoPiDouble = 2.0 * std::numbers::pi;

// Cosine of an edge plane's normal to the rectangle's normal, for an edge at signed distance a from the foot point.
double edge_cosine(double a, double height) { return a / std::sqrt(a * a + height * height); }

}  // namespace

RectangleLight::RectangleLight(const Light& light)
    : patch_(light.position, light.half_u, light.half_v, light.direction),
      x_axis_(normalize_or(light.half_u, {1, 0, 0})),
      y_axis_(normalize_or(light.half_v, {0, 1, 0})),
      half_width_(length(light.half_u)),
      half_height_(length(light.half_v)),
      right_angled_(std::fabs(dot(x_axis_, y_axis_)) < 1e-4f),
      radiance_(light.intensity) {}

double RectangleLight::power() const { return double{kPi} * patch_.area() * strength(radiance_); }

LightBounds RectangleLight::bounds() const { return patch_.bounds(power()); }

RectangleLight::View RectangleLight::view_from(Vec3 point) const {
    const Vec3 to_center = patch_.center() - point;
    const double x = dot(to_center, x_axis_), y = dot(to_center, y_axis_);
    return {x - half_width_, x + half_width_, y - half_height_, y + half_height_, patch_.height(point)};
}

double RectangleLight::View::solid_angle() const {
    // Of the rectangle between the foot point and a corner, signed.
    const auto corner = [h = height](double x, double y) {
        return arctangent2(x * y, h * std::sqrt(x * x + y * y + h * h));
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

// The first number cuts off a share of the solid angle by a plane through the foot axis y at x; the second picks y
// uniformly in the sine of the remaining arc.
RectangleLight::View::Position RectangleLight::View::sample(Vec2 u) const {
    const double z = height;
    const double n0 = -edge_cosine(y0, z), n1 = edge_cosine(x1, z), n2 = edge_cosine(y1, z), n3 = -edge_cosine(x0, z);
    // Inner angles of the spherical polygon.
    const double g0 = arccosine(-n0 * n1), g1 = arccosine(-n1 * n2), g2 = arccosine(-n2 * n3), g3 = arccosine(-n3 * n0);

    const double angle = u.x * (g0 + g1 - kTwoPiDouble) + (u.x - 1.0) * (g2 + g3);
    const SinCosDouble sc = sincos_radians(angle);
    const double f = (sc.cosine * n0 - n2) / sc.sine;
    const double c = std::copysign(1.0 / std::sqrt(f * f + n0 * n0), f);
    const double rest = (1.0 - c) * (1.0 + c);
    const double x = rest > 0.0 ? std::clamp(c * z / std::sqrt(rest), x0, x1) : (c > 0.0 ? x1 : x0);

    const double d2 = x * x + z * z;
    const double s0 = y0 / std::sqrt(d2 + y0 * y0), s1 = y1 / std::sqrt(d2 + y1 * y1);
    const double s = s0 + u.y * (s1 - s0);
    const double cosine2 = (1.0 - s) * (1.0 + s);
    const double y = cosine2 > 0.0 ? std::clamp(s * std::sqrt(d2 / cosine2), y0, y1) : (s > 0.0 ? y1 : y0);
    return {x, y};
}

double RectangleLight::sampled_solid_angle(const View& view) const {
    if (!right_angled_) return 0.0;
    const double omega = view.solid_angle();
    return omega > kSmallSolidAngle ? omega : 0.0;
}

LightSample RectangleLight::sample(Vec3 point, Vec2 u) const {
    const View view = view_from(point);
    if (!(view.height > 0.0)) return {};
    const double omega = sampled_solid_angle(view);
    LightSample sample;
    if (omega == 0.0) {
        sample = patch_.towards(point, {2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f}, patch_.area());
        sample.weight *= radiance_;
        return sample;
    }
    const View::Position p = view.sample(u);
    const double distance = std::sqrt(p.x * p.x + p.y * p.y + view.height * view.height);
    sample.direction = normalize(x_axis_ * static_cast<float>(p.x) + y_axis_ * static_cast<float>(p.y) -
                                 patch_.normal() * static_cast<float>(view.height));
    sample.distance = static_cast<float>(distance);
    sample.pdf = static_cast<float>(1.0 / omega);
    sample.weight = radiance_ * static_cast<float>(omega);
    return sample;
}

LightHit RectangleLight::intersect(Vec3 origin, Vec3 direction) const {
    const PlanarPatch::Crossing c = patch_.cross_plane(origin, direction);
    if (c.distance == 0.0f || std::fabs(c.st.x) > 1.0f || std::fabs(c.st.y) > 1.0f) return {};
    const double omega = sampled_solid_angle(view_from(origin));
    const float pdf =
        omega > 0.0 ? static_cast<float>(1.0 / omega) : area_to_solid_angle(c.distance, c.cosine, patch_.area());
    return {radiance_, pdf, c.distance};
}

}  // namespace lumel
