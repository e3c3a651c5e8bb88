// Based on: Kajiya 1986 (path tracing); Veach 1997, ch. 9 (power heuristic) and 10.4 (roulette); O'Donnell 2018,
// "Precomputed Global Illumination in Frostbite" (sample points per texel, validity by back faces, the stop rule).
// Differs from Frostbite: Owen-scrambled Sobol points instead of rotated Halton; vertex normals; area lights and sky
// are combined by MIS; void paths leave the count too.
#include "path/path_integrator.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "base/prefetch.h"
#include "base/try.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "path/enclosed_points.h"
#include "path/texel_sink.h"
#include "texel/ray_offset.h"

namespace lumel {
namespace {

// Pairs of random numbers of one vertex: direction, sky, point on a local light, (its choice, roulette), then one a
// sun.
enum Pair : std::uint32_t { kDirectionPair, kSkyPair, kLocalPair, kChoicePair, kFirstSunPair };

constexpr std::uint32_t kRouletteFrom = 3;             // the first vertex after which a path may be ended by chance
constexpr std::uint32_t kDirectionSalt = 0x51ed270bu;  // of the alpha keys of sampled directions
constexpr float kNearHit = 2.0f;  // first hits nearer than so many edges of a cell see its steps: paths go on there
constexpr float kShadowShortening = 1.0f - 1e-4f;  // of shadow rays to finite lights, against hitting the light itself

float power_heuristic(float pdf, float other_pdf) {
    const float a = pdf * pdf;
    const float b = other_pdf * other_pdf;
    // Squares overflow for nearly singular densities; there the larger one has it all.
    if (!std::isfinite(a)) return std::isfinite(b) ? 1.0f : 0.5f;
    return a / (a + b);
}

// Of the rays from one vertex of a path: different for each, and mixed by who uses it.
std::uint32_t alpha_key(const PathStart& start, std::uint32_t salt) {
    return start.key + start.index * 0x85ebca6bu + salt * 0x9e3779b9u;
}

// Which of n points a sample starts from. Counts that do not fill a whole round of the points leave out others in each
// texel; blocks of a power of two keep the order's even spread.
std::size_t point_of(std::uint32_t sample, std::uint32_t key, std::size_t n) {
    return (n == kSamplesPerTexel ? sample ^ key : sample + key) % n;
}

bool is_black(Vec3 c) { return c.x <= 0.0f && c.y <= 0.0f && c.z <= 0.0f; }

}  // namespace

// One lane is one path. Arrays are indexed by lane unless they say otherwise.
class PathIntegrator::Workspace {
public:
    struct Vertex {
        Vec3 position;        // on the surface, lifted towards the side the path is on
        Vec3 normal;          // shading normal on that side
        Vec3 face_normal;     // geometric normal on that side; zero at the start of a path, where it does not limit
        Vec3 reflectance;     // albedo / pi
        float direction_pdf;  // solid-angle density with which `direction` was drawn
        Vec3 direction;
        std::uint32_t triangle;  // that it lies on; its own rays cannot hit it
    };
    // A light sample waiting for its shadow ray.
    struct Pending {
        std::uint32_t lane;
        Layer layer;
        Vec3 direction;
        Vec3 value;  // radiance over density, MIS included; times throughput after a bounce
    };

    std::array<Vertex, kWavefrontLanes> vertex;
    std::array<Vec3, kWavefrontLanes> throughput;
    std::array<Vec3, kWavefrontLanes> bounced;  // light gathered after the first hit, radiance of the first ray
    std::array<Vec3, kWavefrontLanes> first_direction;
    std::array<float, kWavefrontLanes> first_pdf;
    std::array<std::uint32_t, kWavefrontLanes> lanes;  // of the paths still alive
    std::array<Ray, kWavefrontLanes> rays;             // by position in `lanes`
    std::array<Hit, kWavefrontLanes> hits;
    std::array<AlbedoLookup, kWavefrontLanes> albedo;  // at `hits`

    std::vector<Ray> shadow_rays;
    std::vector<Pending> pending;
    std::vector<std::uint8_t> blocked;

    std::array<PathStart, kWavefrontLanes> starts;
    std::array<SurfaceStart, kSamplesPerTexel> surfaces;
    std::array<SurfaceStart, kSamplesPerTexel> back_surfaces;
    std::array<std::uint8_t, kSamplesPerTexel> sides;
};

PathOptions transport_options(const BakeOptions& options) {
    PathOptions out;
    out.bounces = options.bounces;
    out.seed = options.seed;
    const auto direct = static_cast<float>(options.direct_scale), indirect = static_cast<float>(options.indirect_scale);
    out.layer_scale = {direct, direct, indirect};
    out.included = {options.include.direct, options.include.sky, options.include.indirect};
    return out;
}

PathIntegrator::PathIntegrator(const Transport& transport, const PathOptions& options)
    : transport_(transport),
      options_(options),
      pairs_per_vertex_(kFirstSunPair + static_cast<std::uint32_t>(transport.lights.sun_count())),
      any_double_sided_(std::ranges::any_of(transport.geometry.triangles, [](const WorldTriangle& triangle) {
          return (triangle.flags & kDoubleSided) != 0;
      })) {}

PathIntegrator::~PathIntegrator() = default;

void PathIntegrator::WorkspaceDeleter::operator()(Workspace* workspace) const { delete workspace; }

PathIntegrator::WorkspacePtr PathIntegrator::make_workspace() const {
    WorkspacePtr workspace(new Workspace);
    const std::size_t events = kWavefrontLanes * (2 + transport_.lights.sun_count());
    workspace->shadow_rays.reserve(events);
    workspace->pending.reserve(events);
    workspace->blocked.reserve(events);
    return workspace;
}

namespace {

// What a batch of paths reads at its hits lies scattered over memory: asked for in the order in which one thing leads
// to the next, for all hits, it arrives while the others are asked for.
void begin_surfaces(std::span<const Hit> hits, const WorldGeometry& geometry, const SurfaceReader& surfaces,
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

// Light samples of one vertex, queued with their shadow rays. Shared by the first vertex (bounced = false, where every
// sample is an event of its own with a direction) and the later ones (where only the sum matters).
template <class Workspace>
class LightQueue {
public:
    LightQueue(const Transport& transport, Workspace& workspace) : transport_(transport), workspace_(workspace) {
        workspace_.pending.clear();
        workspace_.shadow_rays.clear();
    }

    // `pdf_of(cosine)`: density of the direction sampling at this vertex, for MIS. `value_of(cosine)`: what multiplies
    // the light sample's weight.
    template <class PdfOf, class ValueOf>
    void sample_all(std::uint32_t lane, const PathStart& start, std::uint32_t first_pair, bool bounced, PdfOf&& pdf_of,
                    ValueOf&& value_of) {
        const Sampler sampler(start.key, start.index);
        const auto& vertex = workspace_.vertex[lane];
        const LightSet& lights = transport_.lights;
        const std::uint32_t key = alpha_key(start, first_pair);
        for (std::size_t sun = 0; sun < lights.sun_count(); ++sun) {
            const std::uint32_t pair = first_pair + kFirstSunPair + static_cast<std::uint32_t>(sun);
            const Vec2 u = lights.samples_sun(sun) ? sampler.pair(pair) : Vec2{};
            push(lane, Layer::direct, vertex, lights.sample_sun(sun, u, bounced), key, pdf_of, value_of);
        }
        if (lights.samples_sky())
            push(lane, Layer::sky, vertex, lights.sample_sky(sampler.pair(first_pair + kSkyPair)), key, pdf_of,
                 value_of);
        if (lights.has_local())
            push(lane, Layer::direct, vertex,
                 lights.sample_local({vertex.position, vertex.normal}, sampler.one(first_pair + kChoicePair),
                                     sampler.pair(first_pair + kLocalPair), bounced),
                 key, pdf_of, value_of);
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
        const float mis = sample.pdf > 0.0f ? power_heuristic(sample.pdf, pdf_of(cosine)) : 1.0f;
        workspace_.pending.push_back({lane, layer, sample.direction, value_of(cosine) * sample.weight * mis});
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
};

}  // namespace

// Sink: void_path(lane); free_path(lane, direction, pdf, distance or infinity, sky);
// light(lane, layer, direction, radiance over density). kFromCell: the start is a cell's, whose light is what a bounce
// sees of it, and paths that end at a cell are links: link(lane, direction, pdf, cell, share of its irradiance).
template <class Sink>
void PathIntegrator::trace_paths(std::span<const PathStart> starts, Workspace& w, Sink& sink) const {
    LUMEL_CHECK(starts.size() <= kWavefrontLanes, starts.size());
    const LightSet& lights = transport_.lights;
    const WorldGeometry& geometry = transport_.geometry;
    const SurfaceCells* cells = transport_.cells;

    // First rays: over the hemisphere of the start's normal.
    const std::size_t count = starts.size();
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const Sampler sampler(starts[lane].key, starts[lane].index);
        const Vec3 local = GatherHemisphere::sample(sampler.pair(kDirectionPair));
        auto& vertex = w.vertex[lane];
        vertex.position = starts[lane].origin;
        vertex.normal = starts[lane].normal;
        vertex.face_normal = {};
        vertex.triangle = starts[lane].skip;
        vertex.direction = Frame(vertex.normal).to_world(local);
        vertex.direction_pdf = GatherHemisphere::pdf(local.z);
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

    // Void paths end here.
    std::size_t alive = 0;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const Hit& hit = w.hits[lane];
        if (!hit.missed() && hit.back_face && !(geometry.triangles[hit.triangle].flags & kDoubleSided)) {
            sink.void_path(lane);
        } else {
            w.hits[alive] = hit;
            w.lanes[alive++] = lane;
        }
    }

    // Light that reaches the start from sampled directions, of void paths too.
    {
        LightQueue<Workspace> queue(transport_, w);
        for (std::uint32_t lane = 0; lane < count; ++lane) {
            queue.sample_all(
                lane, starts[lane], 0, Sink::kFromCell, [](float cosine) { return GatherHemisphere::pdf(cosine); },
                [](float) {
                    return Vec3{1, 1, 1};
                });
        }
        queue.resolve([&](const auto& event) { sink.light(event.lane, event.layer, event.direction, event.value); });
    }

    for (std::uint32_t bounce = 0;; ++bounce) {
        const bool first = bounce == 0;
        const bool bounced = !first || Sink::kFromCell;
        const std::uint32_t first_pair = (bounce + 1) * pairs_per_vertex_;
        const auto arrive = [&](std::uint32_t lane, Layer layer, const LightHit& light) {
            if (is_black(light.radiance)) return;
            const auto& vertex = w.vertex[lane];
            const float mis = light.pdf > 0.0f ? power_heuristic(vertex.direction_pdf, light.pdf) : 1.0f;
            if (first)
                sink.light(lane, layer, vertex.direction, light.radiance * (mis / vertex.direction_pdf));
            else
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
            if (lights.has_shapes())
                lights.shapes_along({vertex.position, vertex.normal}, vertex.direction, distance, bounced,
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
            if (hit.back_face && !(triangle.flags & kDoubleSided)) continue;
            if (triangle.flags & kEmissive)
                arrive(lane, Layer::direct,
                       lights.emissive({vertex.position, vertex.normal}, hit.triangle, hit.b1, hit.b2, vertex.direction,
                                       hit.t, hit.back_face, bounced));
            if (bounce == options_.bounces || (triangle.flags & kOccluderOnly)) continue;

            // The path stands on a new surface.
            const float side = hit.back_face ? -1.0f : 1.0f;
            vertex.face_normal = geometry.geometric_normal(hit.triangle) * side;
            vertex.normal = geometry.shading_normal(hit.triangle, hit.b1, hit.b2) * side;
            vertex.position = offset_origin(geometry, hit.triangle, hit.b1, hit.b2, vertex.face_normal);
            vertex.triangle = hit.triangle;
            vertex.reflectance = SurfaceReader::finish(w.albedo[i]) * kInvPi;
            if (is_black(vertex.reflectance)) continue;
            if (cells) {
                const Vec2 jitter = Sampler(starts[lane].key, starts[lane].index).pair(first_pair + kDirectionPair);
                const auto [home, cell] = cells->find(hit.triangle, hit.b1, hit.b2, hit.back_face, jitter);
                if (home != kNone && !(first && hit.t < kNearHit * cells->edge(home))) {
                    const Vec3 share = w.throughput[lane] * vertex.reflectance * kPi;
                    if constexpr (Sink::kFromCell)
                        sink.link(lane, w.first_direction[lane], w.first_pdf[lane], cell, share);
                    else
                        w.bounced[lane] += share * cells->irradiance(cell);
                    continue;
                }
            }
            w.lanes[kept++] = lane;
        }
        alive = kept;
        if (alive == 0) break;

        // Direct light on it.
        LightQueue<Workspace> queue(transport_, w);
        for (std::size_t i = 0; i < alive; ++i) {
            const std::uint32_t lane = w.lanes[i];
            const Vec3 scale = w.throughput[lane] * w.vertex[lane].reflectance;
            queue.sample_all(
                lane, starts[lane], first_pair, true, [](float cosine) { return CosineHemisphere::pdf(cosine); },
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

    for (std::uint32_t lane = 0; lane < count; ++lane)
        if (!is_black(w.bounced[lane]))
            sink.light(lane, Layer::indirect, w.first_direction[lane], w.bounced[lane] * (1.0f / w.first_pdf[lane]));
}

void PathIntegrator::surface_starts(std::span<const SamplePoint> points, std::span<const std::uint8_t> back_side,
                                    Workspace& w, std::span<SurfaceStart> out) const {
    LUMEL_CHECK(points.size() <= kWavefrontLanes && out.size() >= points.size(), points.size(), out.size());
    const WorldGeometry& geometry = transport_.geometry;
    std::size_t lifted = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const auto [triangle, b1, b2] = points[i];
        const float side = back_side[i] ? -1.0f : 1.0f;
        const Vec3 face_normal = geometry.geometric_normal(triangle) * side;
        out[i].normal = geometry.shading_normal(triangle, b1, b2) * side;
        out[i].origin = offset_origin(geometry, triangle, b1, b2, face_normal);
        out[i].skip = triangle;
        if (!(geometry.triangles[triangle].flags & kCurved)) continue;
        out[i].skip = kNone;  // directions below the facet meet it, else they would leave a hollow through its wall
        const Vec3 move =
            smooth_position(geometry, triangle, b1, b2, back_side[i] != 0) - geometry.position(triangle, b1, b2);
        const float distance = length(move);
        if (!(distance > 0.0f)) continue;
        w.lanes[lifted] = i;
        w.rays[lifted] = {};
        w.rays[lifted].origin = out[i].origin;
        w.rays[lifted].direction = move / distance;
        w.rays[lifted].tmax = distance;
        w.rays[lifted].skip = triangle;
        ++lifted;
    }
    if (lifted == 0) return;
    w.blocked.resize(lifted);
    transport_.tracer.occluded(std::span(w.rays).first(lifted), w.blocked);
    for (std::size_t k = 0; k < lifted; ++k)
        if (!w.blocked[k]) out[w.lanes[k]].origin += w.rays[k].direction * w.rays[k].tmax;
}

namespace {

// Only the irradiance of each path, for pictures.
class IrradianceSink {
public:
    static constexpr bool kFromCell = false;

    IrradianceSink(const PathOptions& options, std::span<const PathStart> starts, std::span<Vec3> irradiance,
                   std::span<std::uint8_t> valid)
        : options_(options), starts_(starts), irradiance_(irradiance), valid_(valid) {
        std::fill(irradiance.begin(), irradiance.end(), Vec3{});
        std::fill(valid.begin(), valid.end(), std::uint8_t{1});
    }
    void void_path(std::uint32_t lane) { valid_[lane] = 0; }
    void free_path(std::uint32_t, Vec3, float, float, bool) {}
    void light(std::uint32_t lane, Layer of, Vec3 direction, Vec3 value) {
        const auto layer = static_cast<std::size_t>(of);
        if (!options_.included[layer]) return;
        const float cosine = std::max(0.0f, dot(direction, starts_[lane].normal));
        irradiance_[lane] += value * (options_.layer_scale[layer] * cosine * kInvPi);
    }

private:
    const PathOptions& options_;
    std::span<const PathStart> starts_;
    std::span<Vec3> irradiance_;
    std::span<std::uint8_t> valid_;
};

}  // namespace

namespace {

// What reaches a cell by itself, and its links.
class CellSink {
public:
    static constexpr bool kFromCell = true;

    CellSink(std::span<CellLink> links, CellGather& gather) : links_(links), gather_(gather) {}

    void begin(std::span<const PathStart> starts, std::uint32_t first) {
        starts_ = starts;
        first_ = first;
        gather_.traced += static_cast<std::uint32_t>(starts.size());
        gather_.count += static_cast<std::uint32_t>(starts.size());
    }
    void void_path(std::uint32_t) { --gather_.count; }
    void free_path(std::uint32_t, Vec3, float, float, bool) {}
    void light(std::uint32_t lane, Layer, Vec3 direction, Vec3 value) {
        sum_ += value * (std::max(0.0f, dot(direction, starts_[lane].normal)) * kInvPi);
    }
    void link(std::uint32_t lane, Vec3 direction, float pdf, std::uint32_t cell, Vec3 share) {
        const float cosine = std::max(0.0f, dot(direction, starts_[lane].normal));
        CellLink& link = links_[first_ + lane];
        link.from = cell;
        for (std::size_t c = 0; c < 3; ++c)
            link.weight[c] = static_cast<std::uint16_t>(
                std::min(65535.0f, share[c] * (cosine * kInvPi / pdf * CellLink::kOne) + 0.5f));
    }
    void end() {
        if (gather_.count > 0) gather_.direct = sum_ * (1.0f / static_cast<float>(gather_.count));
    }

private:
    std::span<CellLink> links_;
    CellGather& gather_;
    std::span<const PathStart> starts_;
    std::uint32_t first_ = 0;
    Vec3 sum_{};
};

}  // namespace

void PathIntegrator::gather_cell(const GatherSite& site, bool back, Workspace& w, CellGather& out,
                                 std::span<CellLink> links) const {
    LUMEL_CHECK(!site.points.empty() && site.points.size() <= kSamplesPerTexel, site.points.size());
    const std::uint32_t key = sampler_key(options_.seed, site.id);
    std::size_t n = site.points.size();
    std::fill(w.sides.begin(), w.sides.end(), static_cast<std::uint8_t>(back));
    surface_starts(site.points, std::span(w.sides).first(n), w, w.surfaces);
    if (any_double_sided_) {
        // A texel that is shut in is gathered all the same, for it has to have some light; nobody sees such a cell.
        const auto starts = std::span(w.surfaces).first(n);
        const std::uint64_t enclosed = enclosed_points(starts, kEnclosureReach * site.texel_size, mix32(key),
                                                       transport_.tracer, transport_.geometry, w.rays, w.hits);
        if (static_cast<std::size_t>(std::popcount(enclosed)) == n) return;
        n = keep_open_points(starts, enclosed);
    }
    CellSink sink(links, out);
    for (std::uint32_t base = 0; base < links.size(); base += kWavefrontLanes) {
        const auto lanes = std::min<std::uint32_t>(kWavefrontLanes, static_cast<std::uint32_t>(links.size()) - base);
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            const SurfaceStart& start = w.surfaces[point_of(base + lane, key, n)];
            w.starts[lane] = {start.origin, start.normal, key, base + lane, start.skip};
        }
        const auto starts = std::span<const PathStart>(w.starts).first(lanes);
        sink.begin(starts, base);
        trace_paths(starts, w, sink);
    }
    sink.end();
}

void PathIntegrator::gather_irradiance(std::span<const PathStart> starts, Workspace& workspace,
                                       std::span<Vec3> irradiance, std::span<std::uint8_t> valid) const {
    IrradianceSink sink(options_, starts, irradiance, valid);
    trace_paths(starts, workspace, sink);
}

void PathIntegrator::gather_texel(const GatherSite& site, Workspace& w, RadianceSums& out, std::size_t index,
                                  const Context& context) const {
    const std::span<const SamplePoint> points = site.points;
    LUMEL_CHECK(!points.empty() && points.size() <= kSamplesPerTexel, points.size());
    const std::uint32_t key = sampler_key(options_.seed, site.id);
    const bool both_sides =
        options_.two_sided && (transport_.geometry.triangles[points[0].triangle].flags & kDoubleSided) != 0;

    std::size_t n = points.size();
    std::fill(w.sides.begin(), w.sides.end(), std::uint8_t{0});
    surface_starts(points, std::span(w.sides).first(n), w, w.surfaces);
    if (both_sides) {
        std::fill(w.sides.begin(), w.sides.end(), std::uint8_t{1});
        surface_starts(points, std::span(w.sides).first(n), w, w.back_surfaces);
    } else if (any_double_sided_) {
        const auto starts = std::span(w.surfaces).first(n);
        n = keep_open_points(starts, enclosed_points(starts, kEnclosureReach * site.texel_size, mix32(key),
                                                     transport_.tracer, transport_.geometry, w.rays, w.hits));
    }

    TexelSink sink(options_);
    const bool may_stop = options_.stop == StopRule::flux;
    const std::uint32_t step = may_stop ? (options_.samples + 9) / 10 : options_.samples;
    std::uint32_t next_check = step;
    for (std::uint32_t base = 0, lanes = 0; base < options_.samples; base += lanes) {
        if (context.cancelled()) return;
        lanes = std::min({static_cast<std::uint32_t>(kWavefrontLanes), next_check - base, options_.samples - base});
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            const std::uint32_t sample = base + lane;
            // Both sides take turns in pairs, so that each side meets every sample point.
            const bool back = both_sides && ((sample ^ (sample / kSamplesPerTexel)) & 1u) != 0;
            const SurfaceStart& start = (back ? w.back_surfaces : w.surfaces)[point_of(sample, key, n)];
            w.starts[lane] = {start.origin, start.normal, key, sample, start.skip};
        }
        const auto starts = std::span<const PathStart>(w.starts).first(lanes);
        sink.begin(starts, both_sides ? 2.0f : 1.0f);
        trace_paths(starts, w, sink);
        sink.end();
        if (base + lanes == next_check) {
            if (may_stop && sink.converged(options_.relative_error_of_mean)) break;
            next_check += step;
        }
    }
    sink.store(out, index);
}

void RadianceSums::reserve(std::size_t texels) {
    layers.reserve(texels);
    variance.reserve(texels);
    sky_visibility.reserve(texels);
    ambient_occlusion.reserve(texels);
    bent_normal.reserve(texels);
    count.reserve(texels);
    traced.reserve(texels);
}

void RadianceSums::resize(std::size_t texels) {
    layers.resize(texels);
    variance.resize(texels);
    sky_visibility.resize(texels);
    ambient_occlusion.resize(texels);
    bent_normal.resize(texels);
    count.resize(texels);
    traced.resize(texels);
}

Result<RadianceSums> gather_page(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                                 const Transport& transport, const PathOptions& options, std::size_t first,
                                 std::size_t count, Context& context, std::size_t room) {
    LUMEL_CHECK(first + count <= texels.size(), first, count, texels.size());
    RadianceSums sums;
    sums.reserve(room);
    sums.resize(texels.size());
    const PathIntegrator integrator(transport, options);
    std::vector<PathIntegrator::WorkspacePtr> workspaces(context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();

    // Small enough that a cancelled bake stops within a fraction of a second.
    constexpr std::size_t kTexelsPerChunk = 16;
    const std::uint64_t rays_before = transport.tracer.statistics().rays;
    const bool done = parallel_for(
        context, count, kTexelsPerChunk,
        [&](const ChunkRange& range) {
            std::array<SamplePoint, kSamplesPerTexel> points;
            for (std::size_t i = first + range.begin; i < first + range.end; ++i) {
                const std::uint32_t n =
                    sample_points(texels, i, transport.scene, transport.geometry, charts, atlas, points);
                const std::uint64_t id =
                    (std::uint64_t{texels.page} << 32) | (std::uint64_t{texels.y[i]} << 16) | texels.x[i];
                integrator.gather_texel({std::span(points).first(n), id, texels.world_size[i]},
                                        *workspaces[range.worker], sums, i, context);
            }
        },
        "trace", [&] { return transport.tracer.statistics().rays - rays_before; });
    if (!done || context.cancelled()) return Error{ErrorCode::cancelled, "the bake was cancelled", {}, {}};
    return sums;
}

}  // namespace lumel
