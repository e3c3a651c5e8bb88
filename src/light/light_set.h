// All light that reaches a scene, with sample / pdf / evaluation for each kind, so that next-event estimation and rays
// that happen to hit a light can be combined by multiple importance sampling.
//
// Three groups, sampled apart at every vertex of a path: suns (each of them), the sky, and one of the local lights
// (points, spots, area lights, emissive triangles), chosen by a tree for the receiver, or by power alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "light/disc.h"
#include "light/emissive.h"
#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "light/light_tree.h"
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
    // How one of the local lights is chosen.
    enum class Choice : std::uint8_t {
        power,  // the same for every receiver: what the tree is measured against
        tree    // by what it can bring there
    };

    // Borrows geometry and surfaces. Emissive triangles of instances that take part in light transport are lights.
    LightSet(const Scene& scene, const WorldGeometry& geometry, SurfaceReader surfaces, Choice choice = Choice::tree);

    [[nodiscard]] bool empty() const;  // nothing emits: a bake would be black
    [[nodiscard]] std::size_t sun_count() const { return suns_.size(); }
    [[nodiscard]] bool has_sky() const { return has_sky_; }
    // Whether sample_sky has samples (maps), and whether sample_sun reads its numbers (suns with an angular size).
    [[nodiscard]] bool samples_sky() const { return sky_sampler_.has_value(); }
    [[nodiscard]] bool samples_sun(std::size_t sun) const { return suns_[sun].shape.has_size(); }
    [[nodiscard]] bool has_local() const { return !shapes_.empty() || !triangles_.empty(); }

    [[nodiscard]] LightSample sample_sun(std::size_t sun, Vec2 u, bool bounced) const;
    [[nodiscard]] LightSample sample_sky(Vec2 u) const;
    // Parts of the local lights that a LightTable says how often to choose, of light that has not bounced; none where
    // there is nothing to choose, or no tree.
    [[nodiscard]] std::span<const LightTree::Subtree> groups() const;
    [[nodiscard]] double importance_of(std::size_t group, const ReceiverRegion& region) const {
        return trees_[0].importance_of(group, region);
    }
    // u_select picks the light, u the point on it.
    [[nodiscard]] LightSample sample_local(const Receiver& receiver, float u_select, Vec2 u, bool bounced) const;

    // The sky in a direction. Suns are not part of it. A sky of constant colour has no samples (distance 0) and no pdf:
    // sampling the BSDF is all it needs.
    [[nodiscard]] LightHit sky(Vec3 direction) const;
    // Suns with an angular size that contain the direction: radiances add; one LightHit per sun (pdf of that sun).
    [[nodiscard]] LightHit sun(std::size_t sun, Vec3 direction, bool bounced) const;
    // What a ray of the receiver that met an emissive triangle brings, and the density of sample_local there. Only the
    // front emits, unless double-sided.
    [[nodiscard]] LightHit emissive(const Receiver& receiver, std::uint32_t triangle, float b1, float b2,
                                    Vec3 direction, float distance, bool back_face, bool bounced) const;
    // Area lights that are not geometry (rectangle, disc, sphere, point and spot with a radius): they never block rays;
    // every one that the ray crosses before `max_distance` adds its light. Calls add(LightHit) for each.
    template <class Add>
    void shapes_along(const Receiver& receiver, Vec3 direction, float max_distance, bool bounced, Add&& add) const {
        for (const std::uint32_t index : hittable_) {
            const LightHit hit = intersect_shape(index, receiver, direction, bounced);
            // Also where its chance to be sampled is zero: all of its light is the rays' then.
            if (hit.radiance != Vec3{} && hit.distance < max_distance) add(hit);
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
    [[nodiscard]] LightHit intersect_shape(std::uint32_t local, const Receiver& receiver, Vec3 direction,
                                           bool bounced) const;
    struct Chosen {
        std::uint32_t local;  // kNone: none
        float probability;
        std::uint32_t group;  // LightSample::group
    };
    [[nodiscard]] Chosen choose_local(const Receiver& receiver, float u, bool bounced) const;
    [[nodiscard]] float probability_of(const Receiver& receiver, std::uint32_t local, bool bounced) const;
    [[nodiscard]] const LightTree& tree(bool bounced) const { return trees_[bounced && trees_.size() > 1 ? 1 : 0]; }
    [[nodiscard]] Vec3 to_map(Vec3 direction) const;
    [[nodiscard]] Vec3 to_world(Vec3 direction) const;
    void add_sky();
    void add_lights();
    void add_sun(std::uint32_t light);
    void add_shape(Shape shape, std::uint32_t light);
    void add_emissive_triangles();
    void share_by_power();
    void build_trees();

    const Scene* scene_;
    const WorldGeometry* geometry_;
    SurfaceReader surfaces_;
    std::vector<Sun> suns_;
    // Local lights have one numbering: first `shapes_`, then `triangles_`.
    std::vector<Local> shapes_;
    std::vector<EmissiveTriangle> triangles_;
    Choice choice_;
    std::vector<LightTree> trees_;                  // for Choice::tree; one more where bounced light is another
    std::vector<std::uint32_t> local_ends_;         // for Choice::power: math/discrete.h
    std::vector<std::uint32_t> local_of_triangle_;  // per world triangle the number, or kNone; empty: none emits
    std::vector<std::uint32_t> hittable_;           // into shapes_
    bool has_sky_ = false;
    SinCos sky_rotation_{0.0f, 1.0f};
    std::optional<SkySampler> sky_sampler_;  // of the map, if there is one
};

}  // namespace lumel
