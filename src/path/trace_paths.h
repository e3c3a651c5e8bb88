// One wavefront of paths, for any sink. Included where a sink is: path_integrator.cpp, gather_texels.cpp,
// gather_cell.cpp.
//
// Based on: Kajiya 1986 (path tracing); Veach 1997, ch. 9 (power heuristic) and 10.4 (roulette).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/check.h"
#include "base/prefetch.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "path/path_integrator.h"
#include "path/path_workspace.h"
#include "texel/ray_offset.h"

namespace lumel {
namespace path_detail {

// Pairs of random numbers of one vertex: direction, sky, point on a local light, (its choice, roulette), then one a
// sun.
enum Pair : std::uint32_t { kDirectionPair, kSkyPair, kLocalPair, kChoicePair, kFirstSunPair };

inline constexpr std::uint32_t kRouletteFrom = 3;  // the first vertex after which a path may be ended by chance
inline constexpr std::uint32_t kDirectionSalt = 0x51ed270bu;  // of the alpha keys of sampled directions
inline constexpr float kNearHit =
    1.0f;  // first hits nearer than so many edges of a cell see its steps: paths go on there
inline constexpr float kShadowShortening =
    1.0f - 1e-4f;  // of shadow rays to finite lights, against hitting the light itself

inline float power_heuristic(float pdf, float other_pdf) {
    const float a = pdf * pdf;
    const float b = other_pdf * other_pdf;
    // Squares overflow for nearly singular densities; there the larger one has it all.
    if (!std::isfinite(a)) return std::isfinite(b) ? 1.0f : 0.5f;
    return a / (a + b);
}

// Of the rays from one vertex of a path: different for each, and mixed by who uses it.
inline std::uint32_t alpha_key(const PathStart& start, std::uint32_t salt) {
    return start.key + start.index * 0x85ebca6bu + salt * 0x9e3779b9u;
}

// Suns that SurfaceStart::sunlit has a bit for.
inline bool is_point_sun(const LightSet& lights, std::size_t sun) {
    return sun < kMaxPointSuns && !lights.samples_sun(sun);
}

inline bool is_black(Vec3 c) { return c.x <= 0.0f && c.y <= 0.0f && c.z <= 0.0f; }

// What a batch of paths reads at its hits lies scattered over memory: asked for in the order in which one thing leads
// to the next, for all hits, it arrives while the others are asked for.
inline void begin_surfaces(std::span<const Hit> hits, const WorldGeometry& geometry, const SurfaceReader& surfaces,
                           std::span<AlbedoLookup> albedo) {
    for (const Hit& hit : hits)
        if (!hit.missed()) prefetch(&geometry.triangles[hit.triangle]);
    for (const Hit& hit : hits) {
        if (hit.missed()) continue;
        for (const std::uint32_t vertex : geometry.triangles[hit.triangle].vertices) {
            prefetch(&geometry.positions[vertex]);
            prefetch(&geometry.normals[vertex]);
            prefetch(&geometry.uv0[vertex]);
        }
    }
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (!hits[i].missed()) albedo[i] = surfaces.begin_albedo(hits[i].triangle, hits[i].b1, hits[i].b2);
}

// Light samples of one vertex, queued with their shadow rays. Shared by the first vertex (where every
// sample is an event of its own with a direction) and the later ones (where only the sum matters).
template <class Workspace>
class LightQueue {
public:
    // `share`: of the paths, that take a sample.
    LightQueue(const Transport& transport, Workspace& workspace, float share)
        : transport_(transport), workspace_(workspace), share_(share) {
        workspace_.pending.clear();
        workspace_.shadow_rays.clear();
    }

    // `pdf_of(direction, cosine)`: density of the direction sampling at this vertex, for MIS. `value_of(cosine)`: what
    // multiplies the light sample's weight. `suns_known`: suns without size are left out (SurfaceStart::sunlit).
    template <class PdfOf, class ValueOf>
    // `number`: of the sample in the point set; `table`: Receiver::table.
    void sample_all(std::uint32_t lane, const PathStart& start, std::uint32_t number, std::uint32_t first_pair,
                    bool bounced, bool suns_known, const LightTable* table, PdfOf&& pdf_of, ValueOf&& value_of) {
        const Sampler sampler(start.key, number);
        const auto& vertex = workspace_.vertex[lane];
        const LightSet& lights = transport_.lights;
        const std::uint32_t key = alpha_key(start, first_pair);
        for (std::size_t sun = 0; sun < lights.sun_count(); ++sun) {
            if (suns_known && is_point_sun(lights, sun)) continue;
            const std::uint32_t pair = first_pair + kFirstSunPair + static_cast<std::uint32_t>(sun);
            const Vec2 u = lights.samples_sun(sun) ? sampler.pair(pair) : Vec2{};
            push(lane, Layer::direct, vertex, lights.sample_sun(sun, u, bounced), key, pdf_of, value_of);
        }
        if (lights.samples_sky())
            push(lane, Layer::sky, vertex, lights.sample_sky(sampler.pair(first_pair + kSkyPair)), key, pdf_of,
                 value_of);
        if (!lights.has_local()) return;
        const LightSample local =
            lights.sample_local({vertex.position, vertex.normal, table}, sampler.one(first_pair + kChoicePair),
                                sampler.pair(first_pair + kLocalPair), bounced);
        if (table) workspace_.first_light[lane] = {local.group, 0.0f};
        push(lane, Layer::direct, vertex, local, key, pdf_of, value_of);
    }

    // Traces the queue and calls arrive(pending) for each sample that is not blocked, in the order of queueing.
    template <class Arrive>
    void resolve(Arrive&& arrive) {
        workspace_.blocked.resize(workspace_.pending.size());
        transport_.tracer.occluded(workspace_.shadow_rays, workspace_.blocked);
        for (std::size_t i = 0; i < workspace_.pending.size(); ++i)
            if (!workspace_.blocked[i]) arrive(workspace_.pending[i]);
    }

private:
    template <class Vertex, class PdfOf, class ValueOf>
    void push(std::uint32_t lane, Layer layer, const Vertex& vertex, const LightSample& sample, std::uint32_t key,
              PdfOf& pdf_of, ValueOf& value_of) {
        const float cosine = dot(sample.direction, vertex.normal);
        if (sample.distance <= 0.0f || cosine <= 0.0f || is_black(sample.weight)) return;
        if (vertex.face_normal != Vec3{} && dot(sample.direction, vertex.face_normal) <= 0.0f) return;
        const float weight =
            sample.pdf > 0.0f ? power_heuristic(sample.pdf * share_, pdf_of(sample.direction, cosine)) : 1.0f;
        const Vec3 value = value_of(cosine) * sample.weight * (weight / share_);
        workspace_.pending.push_back({lane, layer, sample.direction, value, sample.group});
        Ray ray;
        ray.origin = vertex.position;
        ray.direction = sample.direction;
        ray.tmax = sample.distance < kInfiniteDistance ? sample.distance * kShadowShortening : kInfiniteDistance;
        ray.skip = sample.triangle != kNone ? sample.triangle : vertex.triangle;
        ray.alpha_key = key;
        workspace_.shadow_rays.push_back(ray);
    }

    const Transport& transport_;
    Workspace& workspace_;
    float share_;
};

}  // namespace path_detail

// Sink: back(lane, weight), where the first ray meets the back of a single-sided surface, which is black (weight:
// density without a guide over that with it); free_path(lane, direction, pdf, distance or infinity, sky); light(lane,
// layer, direction, radiance over density). kSunsKnown: PathStart::sunlit is filled in. kFromCell: the start is a
// cell's, whose light is what a bounce sees of it, and paths that end at a cell are links: link(lane, direction, pdf,
// cell, share of its irradiance). kMayBeGuided: there may be guides, and first_radiance, first_sampled and first_light
// of the workspace are filled in.
template <class Sink>
void PathIntegrator::trace_paths(std::span<const PathStart> starts, Workspace& w, Sink& sink,
                                 const Guides& guides) const {
    using namespace path_detail;
    const HemisphereGuide* const guide = guides.directions;
    LUMEL_CHECK(starts.size() <= kWavefrontLanes, starts.size());
    const LightSet& lights = transport_.lights;
    const WorldGeometry& geometry = transport_.geometry;
    const SurfaceCells* cells = transport_.cells;

    // First rays: over the hemisphere of the start's normal.
    const std::size_t count = starts.size();
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const Sampler sampler(starts[lane].key, starts[lane].index);
        HemisphereGuide::Draw draw{sampler.pair(kDirectionPair), 1.0f};
        if (guide) draw = guide->draw(draw.point);
        const Vec3 local = GatherHemisphere::sample(draw.point);
        w.first_draw[lane] = draw;
        w.first_radiance[lane] = 0.0f;
        w.first_sampled[lane] = 0.0f;
        w.first_light[lane] = {kNone, 0.0f};
        auto& vertex = w.vertex[lane];
        vertex.position = starts[lane].origin;
        vertex.normal = starts[lane].normal;
        vertex.face_normal = {};
        vertex.triangle = starts[lane].skip;
        vertex.direction = Frame(vertex.normal).to_world(local);
        vertex.direction_pdf = GatherHemisphere::pdf(local.z) * draw.density;
        w.first_direction[lane] = vertex.direction;
        w.first_pdf[lane] = vertex.direction_pdf;
        w.throughput[lane] = {1, 1, 1};
        w.bounced[lane] = {};
        Ray& ray = w.rays[lane];
        ray = {};
        ray.origin = vertex.position;
        ray.direction = vertex.direction;
        ray.skip = starts[lane].skip;
        ray.alpha_key = alpha_key(starts[lane], kDirectionSalt);
    }
    transport_.tracer.closest(std::span(w.rays).first(count), std::span(w.hits).first(count));

    const auto is_black_back = [&](const Hit& hit) {
        return !hit.missed() && hit.back_face && !(geometry.triangles[hit.triangle].flags & kDoubleSided);
    };
    std::size_t alive = count;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        w.lanes[lane] = lane;
        if (is_black_back(w.hits[lane])) sink.back(lane, 1.0f / w.first_draw[lane].density);
    }

    // Light that reaches the start from sampled directions.
    {
        const bool suns_known = Sink::kSunsKnown && knows_point_suns_;
        LightQueue<Workspace> queue(transport_, w, guides.rate.share());
        for (std::uint32_t lane = 0; lane < count; ++lane) {
            for (std::uint32_t bits = suns_known ? starts[lane].sunlit : 0; bits != 0; bits &= bits - 1) {
                const LightSample sun = lights.sample_sun(std::countr_zero(bits), {}, Sink::kFromCell);
                sink.light(lane, Layer::direct, sun.direction, sun.weight);
            }
            const std::uint32_t index = starts[lane].index;
            if (!guides.rate.takes(index)) continue;
            queue.sample_all(
                lane, starts[lane], guides.rate.number(index), 0, Sink::kFromCell, suns_known, guides.lights,
                [&](Vec3 direction, float cosine) {
                    const float pdf = GatherHemisphere::pdf(cosine);
                    if (!guide) return pdf;
                    return pdf *
                           guide->density(GatherHemisphere::inverse(Frame(starts[lane].normal).to_local(direction)));
                },
                [](float) {
                    return Vec3{1, 1, 1};
                });
        }
        queue.resolve([&](const auto& event) {
            sink.light(event.lane, event.layer, event.direction, event.value);
            if constexpr (Sink::kMayBeGuided) {
                const float value = luminance(event.value) * dot(event.direction, starts[event.lane].normal);
                w.first_sampled[event.lane] += value;
                if (event.group != kNone)
                    w.first_light[event.lane].value =
                        guides.rate.share() * (kGrazing * luminance(event.value) + (1.0f - kGrazing) * value);
            }
        });
    }

    for (std::uint32_t bounce = 0;; ++bounce) {
        const bool first = bounce == 0;
        const bool bounced = !first || Sink::kFromCell;
        const std::uint32_t first_pair = (bounce + 1) * pairs_per_vertex_;
        const auto arrive = [&](std::uint32_t lane, Layer layer, const LightHit& light) {
            if (is_black(light.radiance)) return;
            const auto& vertex = w.vertex[lane];
            const float light_pdf = first ? light.pdf * guides.rate.share() : light.pdf;
            const float mis = light_pdf > 0.0f ? power_heuristic(vertex.direction_pdf, light_pdf) : 1.0f;
            if (first) {
                sink.light(lane, layer, vertex.direction, light.radiance * (mis / vertex.direction_pdf));
                if constexpr (Sink::kMayBeGuided) w.first_radiance[lane] += luminance(light.radiance) * mis;
            } else
                w.bounced[lane] += w.throughput[lane] * light.radiance * mis;
        };

        if (bounce < options_.bounces)
            begin_surfaces(std::span(w.hits).first(alive), geometry, transport_.surfaces, w.albedo);

        // What the rays met: light along the way, the sky, or a surface.
        std::size_t kept = 0;
        for (std::size_t i = 0; i < alive; ++i) {
            const std::uint32_t lane = w.lanes[i];
            const Hit& hit = w.hits[i];
            auto& vertex = w.vertex[lane];
            const float distance = hit.missed() ? kInfiniteDistance : hit.t;
            const Receiver receiver{vertex.position, vertex.normal, first ? guides.lights : nullptr};
            if (lights.has_shapes())
                lights.shapes_along(receiver, vertex.direction, distance, bounced,
                                    [&](const LightHit& light) { arrive(lane, Layer::direct, light); });
            if (first) sink.free_path(lane, vertex.direction, vertex.direction_pdf, distance, hit.missed());
            if (hit.missed()) {
                if (lights.has_sky()) arrive(lane, Layer::sky, lights.sky(vertex.direction));
                for (std::size_t sun = 0; sun < lights.sun_count(); ++sun) {
                    if (!lights.samples_sun(sun)) continue;  // no ray meets a sun without size
                    const LightHit light = lights.sun(sun, vertex.direction, bounced);
                    if (light.pdf > 0.0f) arrive(lane, Layer::direct, light);
                }
                continue;
            }
            const WorldTriangle& triangle = geometry.triangles[hit.triangle];
            if (is_black_back(hit)) continue;
            if (triangle.flags & kEmissive)
                arrive(lane, Layer::direct,
                       lights.emissive(receiver, hit.triangle, hit.b1, hit.b2, vertex.direction, hit.t, hit.back_face,
                                       bounced));
            if (bounce == options_.bounces || (triangle.flags & kOccluderOnly)) continue;

            const Vec3 albedo = SurfaceReader::finish(w.albedo[i]);
            if (is_black(albedo)) continue;
            if (cells) {
                const SurfaceCells::Place place = cells->find(hit.triangle, hit.b1, hit.b2, hit.back_face);
                if (place.home != kNone && !(first && hit.t < kNearHit * cells->edge(place.home))) {
                    const Vec3 share = w.throughput[lane] * albedo;
                    if constexpr (Sink::kFromCell) {
                        const Sampler sampler(starts[lane].key, starts[lane].index);
                        const std::uint32_t cell = cells->pick(place, sampler.pair(first_pair + kDirectionPair));
                        sink.link(lane, w.first_direction[lane], w.first_pdf[lane], cell, share);
                    } else {
                        w.bounced[lane] += share * cells->irradiance(place);
                    }
                    continue;
                }
            }

            // The path stands on a new surface.
            const float side = hit.back_face ? -1.0f : 1.0f;
            vertex.face_normal = geometry.geometric_normal(hit.triangle) * side;
            vertex.normal = geometry.shading_normal(hit.triangle, hit.b1, hit.b2) * side;
            vertex.position = offset_origin(geometry, hit.triangle, hit.b1, hit.b2, vertex.face_normal);
            vertex.triangle = hit.triangle;
            vertex.reflectance = albedo * kInvPi;
            w.lanes[kept++] = lane;
        }
        alive = kept;
        if (alive == 0) break;

        // Direct light on it.
        LightQueue<Workspace> queue(transport_, w, 1.0f);
        for (std::size_t i = 0; i < alive; ++i) {
            const std::uint32_t lane = w.lanes[i];
            const Vec3 scale = w.throughput[lane] * w.vertex[lane].reflectance;
            queue.sample_all(
                lane, starts[lane], starts[lane].index, first_pair, true, false, nullptr,
                [](Vec3, float cosine) { return CosineHemisphere::pdf(cosine); },
                [&](float cosine) { return scale * cosine; });
        }
        queue.resolve([&](const auto& event) { w.bounced[event.lane] += event.value; });

        // On to the next surface.
        kept = 0;
        for (std::size_t i = 0; i < alive; ++i) {
            const std::uint32_t lane = w.lanes[i];
            auto& vertex = w.vertex[lane];
            const Sampler sampler(starts[lane].key, starts[lane].index);
            w.throughput[lane] *= vertex.reflectance * kPi;  // cosine-weighted directions: f cos / pdf = albedo
            if (bounce + 1 >= kRouletteFrom) {
                const float survival = std::min(1.0f, max_component(w.throughput[lane]));
                if (!(sampler.pair(first_pair + kChoicePair).y < survival)) continue;
                w.throughput[lane] *= 1.0f / survival;
            }
            const Vec3 local = CosineHemisphere::sample(sampler.pair(first_pair + kDirectionPair));
            vertex.direction = Frame(vertex.normal).to_world(local);
            vertex.direction_pdf = CosineHemisphere::pdf(local.z);
            if (vertex.direction_pdf <= 0.0f || dot(vertex.direction, vertex.face_normal) <= 0.0f) continue;
            Ray& ray = w.rays[kept];
            ray = {};
            ray.origin = vertex.position;
            ray.direction = vertex.direction;
            ray.skip = vertex.triangle;
            ray.alpha_key = alpha_key(starts[lane], kDirectionSalt + first_pair);
            w.lanes[kept++] = lane;
        }
        alive = kept;
        if (alive == 0) break;
        transport_.tracer.closest(std::span(w.rays).first(alive), std::span(w.hits).first(alive));
    }

    for (std::uint32_t lane = 0; lane < count; ++lane) {
        if (is_black(w.bounced[lane])) continue;
        sink.light(lane, Layer::indirect, w.first_direction[lane], w.bounced[lane] * (1.0f / w.first_pdf[lane]));
        if constexpr (Sink::kMayBeGuided) w.first_radiance[lane] += luminance(w.bounced[lane]);
    }
}

}  // namespace lumel
