#include "light/sphere.h"

#include <algorithm>
#include <cmath>

#include "math/constants.h"
#include "math/frame.h"
#include "math/warp.h"

namespace lumel {
namespace {

// The sphere seen from a point, in double: small and distant spheres lose all digits in float.
struct View {
    double x, y, z;  // to the centre
    double distance_squared, radius_squared;

    View(const Sphere& sphere, Vec3 from)
        : x(double{sphere.center.x} - from.x),
          y(double{sphere.center.y} - from.y),
          z(double{sphere.center.z} - from.z),
          distance_squared(x * x + y * y + z * z),
          radius_squared(double{sphere.radius} * sphere.radius) {}

    [[nodiscard]] bool inside() const { return distance_squared <= radius_squared; }
    // 1 - cos of the half angle of the cone that holds the sphere, without cancellation.
    [[nodiscard]] double one_minus_cos() const {
        const double sine_squared = radius_squared / distance_squared;
        return sine_squared / (1.0 + std::sqrt(1.0 - sine_squared));
    }
};

constexpr float kWholeSpherePdf = 0.25f * kInvPi;

LightSample sample_from_inside(const View& view, Vec2 u) {
    const Vec3 direction = direction_from_z(1.0f - 2.0f * u.x, u.y);
    const double along = view.x * direction.x + view.y * direction.y + view.z * direction.z;
    const double half_chord = std::sqrt(std::max(0.0, view.radius_squared - view.distance_squared + along * along));
    return {direction, static_cast<float>(along + half_chord), Vec3{1, 1, 1} / kWholeSpherePdf, kWholeSpherePdf, kNone};
}

}  // namespace

LightSample sample_sphere(const Sphere& sphere, Vec3 point, Vec2 u) {
    const View view(sphere, point);
    if (view.inside()) return sample_from_inside(view, u);
    const double distance = std::sqrt(view.distance_squared);
    const double one_minus_cos = view.one_minus_cos();
    const float pdf = UniformCone::pdf(static_cast<float>(one_minus_cos));
    const Vec3 axis{static_cast<float>(view.x / distance), static_cast<float>(view.y / distance),
                    static_cast<float>(view.z / distance)};
    const Vec3 direction = Frame(axis).to_world(UniformCone::sample(u, static_cast<float>(one_minus_cos)));
    const double h = u.x * one_minus_cos;  // 1 - cos of the direction, as the cone was sampled
    const double half_chord = std::sqrt(std::max(0.0, view.radius_squared - view.distance_squared * h * (2.0 - h)));
    return {direction, static_cast<float>(distance * (1.0 - h) - half_chord), Vec3{1, 1, 1} / pdf, pdf, kNone};
}

LightHit intersect_sphere(const Sphere& sphere, Vec3 origin, Vec3 direction) {
    const View view(sphere, origin);
    const double along = view.x * direction.x + view.y * direction.y + view.z * direction.z;
    // Squared distance of the centre from the ray by the cross product: the difference of squares would cancel.
    const double cx = view.y * direction.z - view.z * direction.y;
    const double cy = view.z * direction.x - view.x * direction.z;
    const double cz = view.x * direction.y - view.y * direction.x;
    const double half_chord_squared = view.radius_squared - (cx * cx + cy * cy + cz * cz);
    if (half_chord_squared < 0.0) return {};
    const double half_chord = std::sqrt(half_chord_squared);
    if (view.inside()) return {{1, 1, 1}, kWholeSpherePdf, static_cast<float>(along + half_chord)};
    if (along <= 0.0) return {};
    return {
        {1, 1, 1}, UniformCone::pdf(static_cast<float>(view.one_minus_cos())), static_cast<float>(along - half_chord)};
}

double SphereLight::power() const {
    return 4.0 * kPi * kPi * double{sphere_.radius} * sphere_.radius * strength(radiance_);
}

LightBounds SphereLight::bounds() const {
    LightBounds b;
    const Vec3 r{sphere_.radius, sphere_.radius, sphere_.radius};
    b.low = sphere_.center - r;
    b.high = sphere_.center + r;
    b.intensity = power() / (4.0 * double{kPi});
    return b;
}

LightSample SphereLight::sample(Vec3 point, Vec2 u) const {
    LightSample sample = sample_sphere(sphere_, point, u);
    sample.weight *= radiance_;
    return sample;
}

LightHit SphereLight::intersect(Vec3 origin, Vec3 direction) const {
    LightHit hit = intersect_sphere(sphere_, origin, direction);
    hit.radiance *= radiance_;
    return hit;
}

}  // namespace lumel
