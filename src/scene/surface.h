// Material lookups at a point of the world geometry: albedo, emission, opacity.
#pragma once

#include "lumel/scene.h"
#include "scene/world_geometry.h"

namespace lumel {

// Bilinear (or nearest) lookup with the reference's wrap modes; linear R, G, B and A.
Vec4 sample_texture(const Texture& texture, const TextureRef& ref, Vec2 uv);

// Reads materials of one scene over one geometry; cheap to copy, borrows both.
class SurfaceReader {
public:
    SurfaceReader(const Scene& scene, const WorldGeometry& geometry) : scene_(&scene), geometry_(&geometry) {}

    // Diffuse reflectance, each channel in [0, 1]. Zero for occluder-only triangles.
    [[nodiscard]] Vec3 albedo(std::uint32_t triangle, float b1, float b2) const;
    // Emitted radiance of the front face (and of the back of double-sided ones), nits.
    [[nodiscard]] Vec3 emission(std::uint32_t triangle, float b1, float b2) const;
    // Coverage by a ray: 0 or 1 for MASK, alpha for BLEND, 1 for opaque.
    [[nodiscard]] float opacity(std::uint32_t triangle, float b1, float b2) const;

private:
    [[nodiscard]] Vec2 uv(const TextureRef& ref, std::uint32_t triangle, float b1, float b2) const;
    [[nodiscard]] Vec4 base_color(std::uint32_t triangle, float b1, float b2) const;

    const Scene* scene_;
    const WorldGeometry* geometry_;
};

}  // namespace lumel
