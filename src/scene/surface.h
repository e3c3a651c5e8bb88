// Material lookups at a point of the world geometry: albedo, emission, opacity.
#pragma once

#include <array>
#include <cstdint>

#include "lumel/scene.h"
#include "scene/world_geometry.h"

namespace lumel {

// Bilinear (or nearest) lookup with the reference's wrap modes; linear R, G, B and A.
Vec4 sample_texture(const Texture& texture, const TextureRef& ref, Vec2 uv);

// A lookup of the albedo in two steps: the first asks for the texels, so that those of a whole batch of paths are on
// their way from memory before the first is read.
struct AlbedoLookup {
    std::array<const std::uint8_t*, 4> texels{};  // RGBA of low-low, high-low, low-high, high-high; null: no texture
    const std::array<float, 256>* to_linear = nullptr;  // of R, G, B
    Vec2 weight{};                                      // of the high texels
    Vec3 factor{};
};

// Reads materials of one scene over one geometry; cheap to copy, borrows both.
class SurfaceReader {
public:
    SurfaceReader(const Scene& scene, const WorldGeometry& geometry) : scene_(&scene), geometry_(&geometry) {}

    // Diffuse reflectance, each channel in [0, 1]. Zero for occluder-only triangles.
    [[nodiscard]] Vec3 albedo(std::uint32_t triangle, float b1, float b2) const;
    // The same, asked for now and read later.
    [[nodiscard]] AlbedoLookup begin_albedo(std::uint32_t triangle, float b1, float b2) const;
    [[nodiscard]] static Vec3 finish(const AlbedoLookup& lookup);
    // Emitted radiance of the front face (and of the back of double-sided ones), nits.
    [[nodiscard]] Vec3 emission(std::uint32_t triangle, float b1, float b2) const;
    // Coverage by a ray: 0 or 1 for MASK, alpha for BLEND, 1 for opaque.
    [[nodiscard]] float opacity(std::uint32_t triangle, float b1, float b2) const;

private:
    [[nodiscard]] Vec2 uv(const TextureRef& ref, const WorldTriangle& triangle, float b1, float b2) const;
    [[nodiscard]] Vec4 base_factor(const WorldTriangle& triangle, float b1, float b2) const;
    [[nodiscard]] float alpha(const WorldTriangle& triangle, float b1, float b2) const;

    const Scene* scene_;
    const WorldGeometry* geometry_;
};

}  // namespace lumel
