// All light that reaches a scene, with sample / pdf / evaluation for each kind, so that next-event estimation and rays
// that happen to hit a light can be combined by multiple importance sampling.
//
// Three groups, sampled apart at every vertex of a path: suns (each of them), the sky, and one of the local lights
// (points, spots, area lights, emissive triangles), chosen with probability proportional to its power.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/result.h"
#include "lumel/scene.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"

namespace lumel {

inline constexpr float kInfiniteDistance = 1e30f;

// One direction in which light may arrive. Contribution to a vertex with cosine c and BSDF value f, if unoccluded:
// f * c * weight * (pdf > 0 ? mis(pdf, pdf of the BSDF's sampling) : 1).
struct LightSample {
    Vec3 direction{0, 1, 0};   // unit, from the vertex towards the light
    float distance = 0.0f;     // metres to the light; kInfiniteDistance for sun and sky; 0: no sample (weight is zero)
    Vec3 weight{};             // radiance / pdf; for delta lights the irradiance on a facing plane / selection probability
    float pdf = 0.0f;          // per solid angle, selection included; 0 = delta light, cannot be hit by chance
    std::uint32_t triangle = kNone;  // the emissive triangle sampled: shadow rays must not count it as an occluder
};

// Light met by a ray that was sampled for another reason, and the density with which the sampling above would have
// chosen that direction.
struct LightHit {
    Vec3 radiance{};
    float pdf = 0.0f;
    float distance = kInfiniteDistance;
};

// `bounced` is false for the light that arrives at the texel (or camera-visible point) itself and true after a bounce:
// the artist's controls of a light (LightBake, indirect_scale, indirect_color) depend on it.
class LightSet {
public:
    // Borrows geometry and surfaces. Emissive triangles of instances that take part in light transport are lights.
    LightSet(const Scene& scene, const WorldGeometry& geometry, SurfaceReader surfaces);

    [[nodiscard]] bool empty() const;  // nothing emits: a bake would be black
    [[nodiscard]] std::size_t sun_count() const { return suns_.size(); }
    [[nodiscard]] bool has_sky() const { return has_sky_; }
    [[nodiscard]] bool has_local() const { return !local_.empty(); }

    [[nodiscard]] LightSample sample_sun(std::size_t sun, Vec2 u, bool bounced) const;
    [[nodiscard]] LightSample sample_sky(Vec2 u) const;
    // u_select picks the light, u the point on it.
    [[nodiscard]] LightSample sample_local(Vec3 point, float u_select, Vec2 u, bool bounced) const;

    // The sky in a direction. Suns are not part of it.
    [[nodiscard]] LightHit sky(Vec3 direction) const;
    // Suns with an angular size that contain the direction: radiances add; one LightHit per sun (pdf of that sun).
    [[nodiscard]] LightHit sun(std::size_t sun, Vec3 direction, bool bounced) const;
    // Density of sample_local for the given point of an emissive triangle seen from `from`; radiance included. Only the
    // front emits, unless double-sided.
    [[nodiscard]] LightHit emissive(std::uint32_t triangle, float b1, float b2, Vec3 from, Vec3 direction, float distance,
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
    struct Local {                       // one entry of the selection distribution
        std::uint32_t light = kNone;     // into scene lights, or
        std::uint32_t triangle = kNone;  // an emissive triangle
        float probability = 0.0f;        // of being chosen
        float cdf = 0.0f;                // inclusive
    };
    [[nodiscard]] LightHit intersect_shape(std::uint32_t local, Vec3 origin, Vec3 direction, bool bounced) const;

    const Scene* scene_;
    const WorldGeometry* geometry_;
    SurfaceReader surfaces_;
    std::vector<std::uint32_t> suns_;       // into scene lights
    std::vector<Local> local_;              // by ascending cdf
    std::vector<std::uint32_t> hittable_;   // into local_
    std::vector<std::uint32_t> local_of_triangle_;  // per world triangle into local_, or kNone; empty where none emits
    bool has_sky_ = false;
    // Sky sampling: alias table over pixels by luminance times solid angle (light/sky_sampler.h).
    struct SkyPixel {
        float threshold = 1.0f;
        std::uint32_t alias = 0;
        float pdf = 0.0f;  // per solid angle
    };
    std::vector<SkyPixel> sky_pixels_;
};

// Sky preparation, before a LightSet is built ------------------------------------------------------------------------

// Energy-preserving low-pass: every pixel becomes the mean radiance over a cone of the given half angle, then the map is
// rescaled so that its integral over the sphere is exactly kept per channel.
SkyMap blur_sky(const SkyMap& map, float half_angle_radians);

// Finds the sun's disc (the connected set of pixels around the brightest that stand out of the rest), replaces it by its
// surroundings and returns it as a directional light with the removed irradiance, colour and angular size.
// Error: unsupported where no pixel stands out as a sun.
struct ExtractedSun {
    SkyMap sky;
    Light sun;
};
Result<ExtractedSun> extract_sun(const SkyMap& map);

// Radiance of the map in a direction (map space: rotation already undone), bilinear, wrapping in u.
Vec3 lookup(const SkyMap& map, Vec3 direction);
// Map pixel -> direction and back, by the convention of SkyMap.
Vec3 sky_direction(float u, float v);
Vec2 sky_coordinates(Vec3 direction);

}  // namespace lumel
