// All light that reaches a scene, with sample / pdf / evaluation for each kind, so that next-event estimation and rays
// that happen to hit a light can be combined by multiple importance sampling.
//
// Three groups, sampled apart at every vertex of a path: suns (each of them), the sky, and one of the local lights
// (points, spots, area lights, emissive triangles), chosen with probability proportional to its power.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "light/disc.h"
#include "light/light_sample.h"
#include "light/punctual.h"
#include "light/rectangle.h"
#include "light/sky_map.h"
#include "light/sky_sampler.h"
#include "light/sphere.h"
#include "light/sun.h"
#include "lumel/scene.h"
#include "math/trig.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"

namespace lumel {

// `bounced` is false for the light that arrives at the texel (or camera-visible point) itself and true after a bounce:
// the artist's controls of a light (LightBake, indirect_scale, indirect_color) depend on it.
class LightSet {
public:
    // Borrows geometry and surfaces. Emissive triangles of instances that take part in light transport are lights.
    LightSet(const Scene& scene, const WorldGeometry& geometry, SurfaceReader surfaces);

    [[nodiscard]] bool empty() const;  // nothing emits: a bake would be black
    [[nodiscard]] std::size_t sun_count() const { return suns_.size(); }
    [[nodiscard]] bool has_sky() const { return has_sky_; }
    // Whether sample_sky has samples (maps), and whether sample_sun reads its numbers (suns with an angular size).
    [[nodiscard]] bool samples_sky() const { return sky_sampler_.has_value(); }
    [[nodiscard]] bool samples_sun(std::size_t sun) const { return suns_[sun].shape.has_size(); }
    [[nodiscard]] bool has_local() const { return !local_ends_.empty(); }

    [[nodiscard]] LightSample sample_sun(std::size_t sun, Vec2 u, bool bounced) const;
    [[nodiscard]] LightSample sample_sky(Vec2 u) const;
    // u_select picks the light, u the point on it.
    [[nodiscard]] LightSample sample_local(Vec3 point, float u_select, Vec2 u, bool bounced) const;

    // The sky in a direction. Suns are not part of it. A sky of constant colour has no samples (distance 0) and no pdf:
    // sampling the BSDF is all it needs.
    [[nodiscard]] LightHit sky(Vec3 direction) const;
    // Suns with an angular size that contain the direction: radiances add; one LightHit per sun (pdf of that sun).
    [[nodiscard]] LightHit sun(std::size_t sun, Vec3 direction, bool bounced) const;
    // Density of sample_local for the given point of an emissive triangle; radiance included. Only the front emits,
    // unless double-sided.
    [[nodiscard]] LightHit emissive(std::uint32_t triangle, float b1, float b2, Vec3 direction, float distance,
                                    bool back_face) const;
    // Area lights that are not geometry (rectangle, disc, sphere, point and spot with a radius): they never block rays;
    // every one that the ray crosses before `max_distance` adds its light. Calls add(LightHit) for each.
    template <class Add>
    void shapes_along(Vec3 origin, Vec3 direction, float max_distance, bool bounced, Add&& add) const {
        for (const std::uint32_t index : hittable_) {
            const LightHit hit = intersect_shape(index, origin, direction, bounced);
            if (hit.pdf > 0.0f && hit.distance < max_distance) add(hit);
        }
    }
    [[nodiscard]] bool has_shapes() const { return !hittable_.empty(); }

private:
    struct Sun {
        SunLight shape;
        std::array<Vec3, 2> scale;          // the artist's; [1] after a bounce
        std::array<LightSample, 2> centre;  // the sample of a sun without size
    };
    using Shape = std::variant<PunctualLight, RectangleLight, DiscLight, SphereLight>;
    struct Local {
        Shape shape;
        std::uint32_t light;  // into the scene's
    };
    [[nodiscard]] Vec3 artist_scale(std::uint32_t light, bool bounced) const;
    [[nodiscard]] LightHit intersect_shape(std::uint32_t local, Vec3 origin, Vec3 direction, bool bounced) const;
    [[nodiscard]] Vec3 to_map(Vec3 direction) const;
    [[nodiscard]] Vec3 to_world(Vec3 direction) const;
    void add_sky();
    void add_lights();
    void add_sun(std::uint32_t light);
    void add_shape(Shape shape, std::uint32_t light);
    void add_emissive_triangles();
    void share_local_selection();

    const Scene* scene_;
    const WorldGeometry* geometry_;
    SurfaceReader surfaces_;
    std::vector<Sun> suns_;
    // Local lights, the choice among them by power: first `shapes_`, then `triangles_`.
    std::vector<Local> shapes_;
    std::vector<std::uint32_t> triangles_;
    std::vector<std::uint32_t> local_ends_;         // math/discrete.h
    std::vector<std::uint32_t> local_of_triangle_;  // per world triangle into local_ends_, or kNone; empty: none emits
    std::vector<std::uint32_t> hittable_;           // into shapes_
    bool has_sky_ = false;
    SinCos sky_rotation_{0.0f, 1.0f};
    std::optional<SkySampler> sky_sampler_;  // of the map, if there is one
};

}  // namespace lumel
