// Rays through the pixels of a camera, and how far they go: past the backs of single-sided surfaces, as in a viewer.
#pragma once

#include <cstdint>

#include "lumel/scene.h"
#include "scene/world_geometry.h"
#include "trace/tracer.h"

namespace lumel {

class Lens {
public:
    // Of a picture of width x height pixels. Borrows the camera.
    Lens(const Camera& camera, std::uint32_t width, std::uint32_t height);

    // Through a place of the picture in pixels, centres at i + 0.5.
    [[nodiscard]] Ray ray(float x, float y) const;

private:
    const Camera& camera_;
    float tan_y_, tan_x_;
    float inverse_width_, inverse_height_;
};

// The back of a surface that has one side only.
inline bool is_culled(const WorldGeometry& geometry, const Hit& hit) {
    return !hit.missed() && hit.back_face && !(geometry.triangles[hit.triangle].flags & kDoubleSided);
}

// Moves hits of culled backs on along their ray to what a viewer shows there. After 32 of them the last one stays.
void pass_culled(const Tracer& tracer, const WorldGeometry& geometry, Ray& ray, Hit& hit);

}  // namespace lumel
