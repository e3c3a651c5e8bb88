#include "light/emissive.h"

#include <algorithm>
#include <cmath>

#include "light/planar.h"
#include "math/constants.h"
#include "math/warp.h"

namespace lumel {
namespace {

// Points per edge of the grid at which an emission texture is read: one for every 4 x 4 texels that the triangle
// covers.
int grid_size(const Scene& scene, const WorldGeometry& geometry, const WorldTriangle& triangle, const TextureRef& ref) {
    const Texture& texture = scene.textures[ref.texture];
    const std::vector<Vec2>& uv = ref.uv_set == 0 ? geometry.uv0 : geometry.uv1;
    const Vec2 e1 = uv[triangle.vertices[1]] - uv[triangle.vertices[0]];
    const Vec2 e2 = uv[triangle.vertices[2]] - uv[triangle.vertices[0]];
    const float stretch = ref.transform[0] * ref.transform[4] - ref.transform[1] * ref.transform[3];
    const float texels = 0.5f * std::fabs(cross(e1, e2) * stretch) * static_cast<float>(texture.width) *
                         static_cast<float>(texture.height);
    return static_cast<int>(std::clamp(0.5f * std::sqrt(texels), 4.0f, 48.0f));
}

}  // namespace

EmissiveTriangle::EmissiveTriangle(const Scene& scene, const WorldGeometry& geometry, const SurfaceReader& surfaces,
                                   std::uint32_t triangle)
    : corners_(geometry.corners(triangle)),
      normal_(geometry.geometric_normal(triangle)),
      area_(geometry.area(triangle)),
      triangle_(triangle),
      scene_(&scene),
      geometry_(&geometry),
      surfaces_(surfaces) {
    const WorldTriangle& t = geometry.triangles[triangle];
    const Material& material = scene.materials[t.material];
    emission_ = material.emission;
    is_even_ = material.emission_texture.texture == kNone && (t.flags & kNeedsAlpha) == 0;
    double_sided_ = (t.flags & kDoubleSided) != 0;
}

// As rays see it: what they go through sends them no light.
Vec3 EmissiveTriangle::radiance(float b1, float b2) const {
    if (is_even_) return emission_;
    return surfaces_.emission(triangle_, b1, b2) * surfaces_.opacity(triangle_, b1, b2);
}

double EmissiveTriangle::power() const {
    const WorldTriangle& t = geometry_->triangles[triangle_];
    const Material& material = scene_->materials[t.material];
    const int n =
        material.emission_texture.texture == kNone ? 1 : grid_size(*scene_, *geometry_, t, material.emission_texture);
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec2 u{(static_cast<float>(i) + 0.5f) / static_cast<float>(n),
                         (static_cast<float>(j) + 0.5f) / static_cast<float>(n)};
            const Vec2 b = UniformTriangle::sample(u);
            sum += strength(surfaces_.emission(triangle_, b.x, b.y));
        }
    // Bright spots between the points keep a chance to be sampled.
    constexpr double kFloor = 1e-3;
    const double mean = std::max(sum / (n * n), kFloor * strength(material.emission));
    return double{kPi} * area_ * mean * (double_sided_ ? 2.0 : 1.0);
}

LightBounds EmissiveTriangle::bounds() const {
    LightBounds b;
    b.low = b.high = corners_[0];
    for (const Vec3 corner : corners_)
        for (std::size_t c = 0; c < 3; ++c) {
            b.low[c] = std::min(b.low[c], corner[c]);
            b.high[c] = std::max(b.high[c], corner[c]);
        }
    b.axis = normal_;
    b.cos_facing = 1.0f;
    b.both_sides = double_sided_;
    b.intensity = power() / (double{kPi} * (double_sided_ ? 2.0 : 1.0));
    return b;
}

LightSample EmissiveTriangle::sample(Vec3 point, Vec2 u) const {
    const Vec2 b = UniformTriangle::sample(u);
    const Vec3 to_light = corners_[0] * (1.0f - b.x - b.y) + corners_[1] * b.x + corners_[2] * b.y - point;
    const float distance = length(to_light);
    const Vec3 direction = normalize_or(to_light, {});
    const float cosine = -dot(direction, normal_);
    const float emitting_cosine = double_sided_ ? std::fabs(cosine) : cosine;
    if (!(emitting_cosine > 0.0f)) return {};
    const float pdf = area_to_solid_angle(distance, emitting_cosine, area_);
    if (!(pdf > 0.0f) || !std::isfinite(pdf)) return {};
    return {direction, distance, radiance(b.x, b.y) / pdf, pdf, triangle_};
}

LightHit EmissiveTriangle::hit(float b1, float b2, Vec3 direction, float distance, bool back_face) const {
    if (back_face && !double_sided_) return {};
    const float cosine = std::fabs(dot(direction, normal_));
    const bool can_be_sampled = cosine > 0.0f && area_ > 0.0f;
    const float pdf = can_be_sampled ? area_to_solid_angle(distance, cosine, area_) : 0.0f;
    return {surfaces_.emission(triangle_, b1, b2), pdf, distance};
}

}  // namespace lumel
