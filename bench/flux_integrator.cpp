#include "flux_integrator.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/warp.h"
#include "texel/ray_offset.h"

namespace lumel::bench {
namespace {

constexpr std::uint32_t kRouletteFrom = 3;
constexpr float kShadowShortening = 1.0f - 1e-4f;             // of shadow rays to finite lights
constexpr std::uint32_t kSkySample = 1, kFirstSunSample = 2;  // FluxNumbers::on_light; 0 is the local light

float power_heuristic(float pdf, float other) {
    const double a = static_cast<double>(pdf) * static_cast<double>(pdf);
    const double b = static_cast<double>(other) * static_cast<double>(other);
    return static_cast<float>(a / (a + b));
}

bool is_black(Vec3 c) { return max_component(c) <= 0.0f; }

// One lane's path, at its current vertex.
struct Path {
    Vec3 position, normal;
    Vec3 face_normal;  // zero at the texel, where it does not limit
    Vec3 reflectance;  // albedo / pi
    Vec3 direction;
    float pdf;  // of the direction
    std::uint32_t triangle;
    Vec3 throughput, bounced;
    Vec3 first_direction;
    float first_pdf;
};

struct Pending {
    std::uint32_t lane;
    Layer layer;
    Vec3 direction, value;
};

}  // namespace

struct FluxIntegrator::Workspace {
    PathIntegrator::WorkspacePtr lumel;
    std::array<SurfaceStart, kSamplesPerTexel> origins;
    std::array<PathStart, kWavefrontLanes> starts;
    std::array<Path, kWavefrontLanes> paths;
    std::array<std::uint32_t, kWavefrontLanes> lanes;  // of the paths still alive
    std::array<Ray, kWavefrontLanes> rays;             // by position in `lanes`
    std::array<Hit, kWavefrontLanes> hits;
    std::vector<Pending> pending;
    std::vector<Ray> shadow_rays;
    std::vector<std::uint8_t> blocked;
};

void FluxIntegrator::WorkspaceDeleter::operator()(Workspace* workspace) const { delete workspace; }

FluxIntegrator::WorkspacePtr FluxIntegrator::make_workspace() const {
    WorkspacePtr workspace(new Workspace);
    workspace->lumel = lumel_.make_workspace();
    return workspace;
}

FluxIntegrator::FluxIntegrator(const Transport& transport, const PathOptions& options, const FluxChoices& choices)
    : transport_(transport),
      options_(options),
      choices_(choices),
      lights_(transport.scene, transport.geometry, transport.surfaces),
      halton_(choices.points == FluxPoints::halton ? options.samples : 0),
      lumel_(transport, options) {}

float FluxIntegrator::direction_pdf(std::uint32_t vertex, float cosine) const {
    if (vertex > 0) return CosineHemisphere::pdf(cosine);
    return choices_.hemisphere == FluxChoices::Hemisphere::uniform ? kInvTwoPi : GatherHemisphere::pdf(cosine);
}

FluxNumbers FluxIntegrator::numbers(std::uint32_t lane, const Workspace& w) const {
    return {halton_, choices_.points, w.starts[lane].key, w.starts[lane].index};
}

void FluxIntegrator::start_paths(std::size_t count, Workspace& w) const {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const PathStart& start = w.starts[lane];
        const Vec2 u = numbers(lane, w).direction(0);
        const Vec3 local = choices_.hemisphere == FluxChoices::Hemisphere::uniform ? direction_from_z(u.x, u.y)
                                                                                   : GatherHemisphere::sample(u);
        Path& path = w.paths[lane];
        path = {};
        path.position = start.origin;
        path.normal = start.normal;
        path.triangle = start.skip;
        path.direction = path.first_direction = Frame(start.normal).to_world(local);
        path.pdf = path.first_pdf = direction_pdf(0, local.z);
        path.throughput = {1, 1, 1};
        Ray& ray = w.rays[lane];
        ray = {};
        ray.origin = path.position;
        ray.direction = path.direction;
        ray.skip = path.triangle;
        ray.alpha_key = Sampler(start.key, start.index).hash(7);
    }
    transport_.tracer.closest(std::span(w.rays).first(count), std::span(w.hits).first(count));
}

// "Ignore contribution from back face rays": they end where they stand_on() nothing.
void FluxIntegrator::tell_first_hits(std::size_t count, Workspace& w, TexelSink& sink) const {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const Hit& hit = w.hits[lane];
        w.lanes[lane] = lane;
        if (!hit.missed() && hit.back_face && !(transport_.geometry.triangles[hit.triangle].flags & kDoubleSided))
            sink.back(lane, 1.0f);
        sink.free_path(lane, w.paths[lane].direction, w.paths[lane].pdf, hit.missed() ? kInfiniteDistance : hit.t,
                       hit.missed());
    }
}

void FluxIntegrator::push(std::uint32_t lane, std::uint32_t vertex, Layer layer, const LightSample& sample,
                          float weight, Workspace& w) const {
    const Path& path = w.paths[lane];
    const float cosine = dot(sample.direction, path.normal);
    if (sample.distance <= 0.0f || cosine <= 0.0f || is_black(sample.weight)) return;
    if (vertex > 0 && dot(sample.direction, path.face_normal) <= 0.0f) return;
    if (uses_light_set() && sample.pdf > 0.0f) weight *= power_heuristic(sample.pdf, direction_pdf(vertex, cosine));
    Vec3 value = sample.weight * weight;
    if (vertex > 0) value *= path.throughput * path.reflectance * cosine;
    w.pending.push_back({lane, layer, sample.direction, value});
    Ray ray;
    ray.origin = path.position;
    ray.direction = sample.direction;
    ray.tmax = sample.distance < kInfiniteDistance ? sample.distance * kShadowShortening : kInfiniteDistance;
    ray.skip = sample.triangle != kNone ? sample.triangle : path.triangle;
    ray.alpha_key = Sampler(w.starts[lane].key, w.starts[lane].index).hash(8 * vertex + 6);
    w.shadow_rays.push_back(ray);
}

void FluxIntegrator::sample_lights(std::uint32_t lane, std::uint32_t vertex, Workspace& w) const {
    const FluxNumbers random = numbers(lane, w);
    const Vec3 position = w.paths[lane].position;
    const auto count = static_cast<std::uint32_t>(lights_.size());
    switch (choices_.next_event) {
        case FluxChoices::NextEvent::one_light: {
            if (count == 0) return;
            const auto scaled = static_cast<std::uint32_t>(random.light_choice(vertex) * static_cast<float>(count));
            const LightSample sample =
                lights_.sample(std::min(scaled, count - 1), position, random.on_light(vertex, 0));
            push(lane, vertex, Layer::direct, sample, static_cast<float>(count), w);
            return;
        }
        case FluxChoices::NextEvent::all_lights:
            for (std::uint32_t i = 0; i < count; ++i)
                push(lane, vertex, Layer::direct, lights_.sample(i, position, random.on_light(vertex, i)), 1.0f, w);
            return;
        case FluxChoices::NextEvent::light_set: {
            const LightSet& set = transport_.lights;
            const bool bounced = vertex > 0;
            for (std::uint32_t sun = 0; sun < set.sun_count(); ++sun) {
                const Vec2 u = random.on_light(vertex, kFirstSunSample + sun);
                push(lane, vertex, Layer::direct, set.sample_sun(sun, u, bounced), 1.0f, w);
            }
            if (set.samples_sky())
                push(lane, vertex, Layer::sky, set.sample_sky(random.on_light(vertex, kSkySample)), 1.0f, w);
            if (set.has_local())
                push(lane, vertex, Layer::direct,
                     set.sample_local({position, w.paths[lane].normal}, random.light_choice(vertex),
                                      random.on_light(vertex, 0), bounced),
                     1.0f, w);
            return;
        }
    }
}

void FluxIntegrator::resolve_lights(std::uint32_t vertex, Workspace& w, TexelSink& sink) const {
    w.blocked.resize(w.pending.size());
    transport_.tracer.occluded(w.shadow_rays, w.blocked);
    for (std::size_t i = 0; i < w.pending.size(); ++i) {
        if (w.blocked[i]) continue;
        const Pending& light = w.pending[i];
        if (vertex == 0)
            sink.light(light.lane, light.layer, light.direction, light.value);
        else
            w.paths[light.lane].bounced += light.value;
    }
    w.pending.clear();
    w.shadow_rays.clear();
}

// Light that the ray from `vertex` ran into: only the sky, where lights are not combined with the rays.
void FluxIntegrator::meet_lights(std::uint32_t lane, std::uint32_t vertex, const Hit& hit, Workspace& w,
                                 TexelSink& sink) const {
    Path& path = w.paths[lane];
    const LightSet& set = transport_.lights;
    const bool bounced = vertex > 0;
    const auto arrive = [&](Layer layer, const LightHit& light) {
        if (is_black(light.radiance)) return;
        const float mis = uses_light_set() && light.pdf > 0.0f ? power_heuristic(path.pdf, light.pdf) : 1.0f;
        if (bounced)
            path.bounced += path.throughput * light.radiance * mis;
        else
            sink.light(lane, layer, path.direction, light.radiance * (mis / path.pdf));
    };
    if (hit.missed() && set.has_sky()) arrive(Layer::sky, set.sky(path.direction));
    if (!uses_light_set()) return;
    const Receiver receiver{path.position, path.normal};
    if (set.has_shapes())
        set.shapes_along(receiver, path.direction, hit.missed() ? kInfiniteDistance : hit.t, bounced,
                         [&](const LightHit& light) { arrive(Layer::direct, light); });
    if (hit.missed()) {
        for (std::size_t sun = 0; sun < set.sun_count(); ++sun)
            if (set.samples_sun(sun)) arrive(Layer::direct, set.sun(sun, path.direction, bounced));
    } else {
        arrive(Layer::direct,
               set.emissive(receiver, hit.triangle, hit.b1, hit.b2, path.direction, hit.t, hit.back_face, bounced));
    }
}

// Moves the path to the surface that it hit; false where it ends there.
bool FluxIntegrator::stand_on(std::uint32_t lane, const Hit& hit, Workspace& w) const {
    if (hit.missed()) return false;
    const WorldGeometry& geometry = transport_.geometry;
    const WorldTriangle& triangle = geometry.triangles[hit.triangle];
    if (hit.back_face && !(triangle.flags & kDoubleSided)) return false;
    if (triangle.flags & kOccluderOnly) return false;
    const float side = hit.back_face ? -1.0f : 1.0f;
    Path& path = w.paths[lane];
    path.reflectance = transport_.surfaces.albedo(hit.triangle, hit.b1, hit.b2) * kInvPi;
    if (is_black(path.reflectance)) return false;
    path.face_normal = geometry.geometric_normal(hit.triangle) * side;
    path.normal = geometry.shading_normal(hit.triangle, hit.b1, hit.b2) * side;
    path.position = offset_origin(geometry, hit.triangle, hit.b1, hit.b2, path.face_normal);
    path.triangle = hit.triangle;
    return true;
}

// Roulette and the next direction, from a vertex after the first.
bool FluxIntegrator::go_on(std::uint32_t lane, std::uint32_t vertex, Workspace& w) const {
    const FluxNumbers random = numbers(lane, w);
    Path& path = w.paths[lane];
    path.throughput *= path.reflectance * kPi;
    if (vertex >= kRouletteFrom) {
        const float survival = std::min(1.0f, max_component(path.throughput));
        if (!(random.roulette(vertex) < survival)) return false;
        path.throughput *= 1.0f / survival;
    }
    const Vec3 local = CosineHemisphere::sample(random.direction(vertex));
    path.direction = Frame(path.normal).to_world(local);
    path.pdf = CosineHemisphere::pdf(local.z);
    return path.pdf > 0.0f && dot(path.direction, path.face_normal) > 0.0f;
}

void FluxIntegrator::trace_paths(std::size_t count, Workspace& w, TexelSink& sink) const {
    start_paths(count, w);
    tell_first_hits(count, w, sink);
    std::size_t alive = count;
    for (std::uint32_t lane = 0; lane < count; ++lane) sample_lights(lane, 0, w);
    resolve_lights(0, w, sink);

    for (std::uint32_t vertex = 1; alive > 0; ++vertex) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < alive; ++i) {
            const std::uint32_t lane = w.lanes[i];
            const Hit hit = w.hits[i];
            meet_lights(lane, vertex - 1, hit, w, sink);
            if (vertex <= options_.bounces && stand_on(lane, hit, w)) w.lanes[kept++] = lane;
        }
        alive = kept;
        for (std::size_t i = 0; i < alive; ++i) sample_lights(w.lanes[i], vertex, w);
        resolve_lights(vertex, w, sink);

        kept = 0;
        for (std::size_t i = 0; i < alive; ++i) {
            const std::uint32_t lane = w.lanes[i];
            if (!go_on(lane, vertex, w)) continue;
            Ray& ray = w.rays[kept];
            ray = {};
            ray.origin = w.paths[lane].position;
            ray.direction = w.paths[lane].direction;
            ray.skip = w.paths[lane].triangle;
            ray.alpha_key = Sampler(w.starts[lane].key, w.starts[lane].index).hash(8 * vertex + 7);
            w.lanes[kept++] = lane;
        }
        alive = kept;
        transport_.tracer.closest(std::span(w.rays).first(alive), std::span(w.hits).first(alive));
    }
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const Path& path = w.paths[lane];
        if (!is_black(path.bounced))
            sink.light(lane, Layer::indirect, path.first_direction, path.bounced * (1.0f / path.first_pdf));
    }
}

void FluxIntegrator::gather_texel(const GatherSite& site, Workspace& w, RadianceSums& out, std::size_t index) const {
    LUMEL_CHECK(!site.points.empty() && site.points.size() <= kSamplesPerTexel && !options_.two_sided,
                site.points.size());
    const std::uint32_t key = sampler_key(options_.seed, site.id);
    // Lumel's points: even and odd samples are a set each. Halton's: all are one.
    const std::uint32_t sets = choices_.points == FluxPoints::sobol ? 2 : 1;
    const std::array<std::uint32_t, 2> set_keys{key, mix32(key)};
    const std::size_t count = lumel_.choose_starts(site, key, *w.lumel, w.origins).count;
    const auto half_of_origins = static_cast<std::uint32_t>(count / 2);
    TexelSink sink(options_);
    const bool may_stop = options_.stop == StopRule::flux;
    const std::uint32_t step = may_stop ? (options_.samples + 9) / 10 : options_.samples;
    std::uint32_t next_check = step;
    for (std::uint32_t base = 0, lanes = 0; base < options_.samples; base += lanes) {
        lanes = std::min({static_cast<std::uint32_t>(kWavefrontLanes), next_check - base, options_.samples - base});
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            const std::uint32_t set = (base + lane) % sets, sample = (base + lane) / sets;
            PathStart& start = w.starts[lane];
            start = {{}, {}, set_keys[set], sample, kNone};
            const std::size_t random =
                std::min(static_cast<std::size_t>(numbers(lane, w).origin() * static_cast<float>(count)), count - 1);
            const std::uint32_t turn = sample + set * half_of_origins;
            const std::size_t in_turn = (count == kSamplesPerTexel ? turn ^ key : turn + key) % count;
            const SurfaceStart& origin = w.origins[choices_.origins == FluxChoices::Origins::random ? random : in_turn];
            start = {origin.origin, origin.normal, start.key, sample, origin.skip};
        }
        sink.begin(std::span<const PathStart>(w.starts).first(lanes), 1.0f);
        trace_paths(lanes, w, sink);
        sink.end();
        if (base + lanes != next_check) continue;
        if (may_stop && sink.converged(options_.relative_error_of_mean)) break;
        next_check += step;
    }
    sink.store(out, index);
}

}  // namespace lumel::bench
