// Emissive triangles of the scene as lights, sampled uniformly by area. The front emits, and the back of double-sided
// ones.
#pragma once

#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"

namespace lumel {

// A view of one triangle.
class EmissiveTriangle {
public:
    EmissiveTriangle(const WorldGeometry& geometry, const SurfaceReader& surfaces, std::uint32_t triangle)
        : geometry_(&geometry), surfaces_(surfaces), triangle_(triangle), area_(geometry.area(triangle)) {}

    [[nodiscard]] std::uint32_t triangle() const { return triangle_; }

    // Estimated from the emission texture at fixed points; never zero for a triangle with an area whose material emits.
    [[nodiscard]] double power(const Scene& scene) const;
    [[nodiscard]] LightBounds bounds(const Scene& scene) const;
    [[nodiscard]] LightSample sample(Vec3 point, Vec2 u) const;
    // What a ray that hit the triangle meets there.
    [[nodiscard]] LightHit hit(float b1, float b2, Vec3 direction, float distance, bool back_face) const;

private:
    [[nodiscard]] bool double_sided() const { return (geometry_->triangles[triangle_].flags & kDoubleSided) != 0; }

    const WorldGeometry* geometry_;
    SurfaceReader surfaces_;
    std::uint32_t triangle_;
    float area_;
};

// Emits and takes part in light transport.
inline bool is_emitter(const WorldTriangle& triangle) {
    return (triangle.flags & kEmissive) != 0 && (triangle.flags & kOccluderOnly) == 0;
}

}  // namespace lumel
