// Emissive triangles of the scene as lights, sampled uniformly by area. The front emits, and the back of double-sided
// ones.
#pragma once

#include <array>
#include <cstdint>

#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"

namespace lumel {

// One triangle. What a sample reads of it lies together: of ten thousand, each sample takes another one, and what is
// scattered over the scene's tables comes from far memory.
class EmissiveTriangle {
public:
    EmissiveTriangle(const Scene& scene, const WorldGeometry& geometry, const SurfaceReader& surfaces,
                     std::uint32_t triangle);

    [[nodiscard]] std::uint32_t triangle() const { return triangle_; }

    // Estimated from the emission texture at fixed points; never zero for a triangle with an area whose material emits.
    [[nodiscard]] double power() const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] LightSample sample(Vec3 point, Vec2 u) const;
    // What a ray that hit the triangle meets there.
    [[nodiscard]] LightHit hit(float b1, float b2, Vec3 direction, float distance, bool back_face) const;

private:
    [[nodiscard]] Vec3 radiance(float b1, float b2) const;

    std::array<Vec3, 3> corners_;
    Vec3 normal_;
    float area_;  // square metres
    std::uint32_t triangle_;
    Vec3 emission_;  // of the material
    bool is_even_;   // radiance is emission_ everywhere
    bool double_sided_;
    const Scene* scene_;
    const WorldGeometry* geometry_;
    SurfaceReader surfaces_;
};

// Emits and takes part in light transport.
inline bool is_emitter(const WorldTriangle& triangle) {
    return (triangle.flags & kEmissive) != 0 && (triangle.flags & kOccluderOnly) == 0;
}

}  // namespace lumel
