#include "render/camera_rays.h"

#include <cmath>
#include <span>

#include "math/constants.h"

namespace lumel {

Lens::Lens(const Camera& camera, std::uint32_t width, std::uint32_t height)
    : camera_(camera),
      tan_y_(std::tan(0.5f * camera.vertical_fov)),
      tan_x_(tan_y_ * static_cast<float>(width) / static_cast<float>(height)),
      inverse_width_(1.0f / static_cast<float>(width)),
      inverse_height_(1.0f / static_cast<float>(height)) {}

Ray Lens::ray(float x, float y) const {
    const Vec3 local{(2.0f * x * inverse_width_ - 1.0f) * tan_x_, (1.0f - 2.0f * y * inverse_height_) * tan_y_, -1.0f};
    Ray out;
    out.origin = camera_.transform.translation;
    out.direction = normalize(transform_vector(camera_.transform, local));
    return out;
}

void pass_culled(const Tracer& tracer, const WorldGeometry& geometry, Ray& ray, Hit& hit) {
    constexpr int kMaxCulledFaces = 32;
    for (int pass = 0; pass < kMaxCulledFaces && is_culled(geometry, hit); ++pass) {
        ray.tmin = hit.t * (1.0f + 4.0f * kFloatEpsilon) + 1e-6f;
        ray.skip = hit.triangle;
        tracer.closest(std::span(&ray, 1), std::span(&hit, 1));
    }
}

}  // namespace lumel
