// The lights of a scene as Frostbite's path tracer has them: a plain list, from which one is chosen uniformly or all
// are taken. Suns, points, spots and area lights are entries; emissive triangles that hang together are one entry,
// sampled uniformly over its area, as an area light of that shape would be. Controls of the artist (Light::bake,
// indirect_scale, indirect_color) are not for benchmarks.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "light/disc.h"
#include "light/light_sample.h"
#include "light/punctual.h"
#include "light/rectangle.h"
#include "light/sphere.h"
#include "light/sun.h"
#include "lumel/scene.h"
#include "scene/surface.h"

namespace lumel::bench {

class FluxLights {
public:
    // Borrows geometry and surfaces.
    FluxLights(const Scene& scene, const WorldGeometry& geometry, SurfaceReader surfaces);

    [[nodiscard]] std::size_t size() const { return lights_.size(); }
    [[nodiscard]] LightSample sample(std::size_t light, Vec3 point, Vec2 u) const;

private:
    struct EmissiveObject {
        std::vector<std::uint32_t> triangles;
        std::vector<std::uint32_t> ends;  // by area: math/discrete.h
    };
    using Entry = std::variant<SunLight, PunctualLight, RectangleLight, DiscLight, SphereLight, EmissiveObject>;

    void add_emissive_objects();
    [[nodiscard]] LightSample sample_object(const EmissiveObject& object, Vec3 point, Vec2 u) const;

    const Scene* scene_;
    const WorldGeometry* geometry_;
    SurfaceReader surfaces_;
    std::vector<Entry> lights_;
};

}  // namespace lumel::bench
