// Where paths start, and the irradiance that single ones bring. The texels: gather_texels.cpp; the paths themselves:
// trace_paths.h.
#include "path/path_integrator.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "math/sampler.h"
#include "path/path_workspace.h"
#include "path/trace_paths.h"
#include "texel/ray_offset.h"

namespace lumel {

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
      pairs_per_vertex_(path_detail::kFirstSunPair + static_cast<std::uint32_t>(transport.lights.sun_count())),
      any_double_sided_(
          std::ranges::any_of(transport.geometry.triangles,
                              [](const WorldTriangle& triangle) { return (triangle.flags & kDoubleSided) != 0; })),
      knows_point_suns_(options.samples >= kSamplesPerTexel &&
                        std::ranges::none_of(transport.scene.materials, [](const Material& material) {
                            return material.alpha_mode == AlphaMode::blend;
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
        out[i].sunlit = 0;
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

void PathIntegrator::find_sunlit(std::span<SurfaceStart> starts, bool bounced, Workspace& w) const {
    LUMEL_CHECK(starts.size() <= kSamplesPerTexel, starts.size());
    if (!knows_point_suns_) return;
    for (std::size_t sun = 0; sun < transport_.lights.sun_count(); ++sun) {
        if (!path_detail::is_point_sun(transport_.lights, sun)) continue;
        const LightSample sample = transport_.lights.sample_sun(sun, {}, bounced);
        if (path_detail::is_black(sample.weight)) continue;
        w.shadow_rays.clear();
        for (std::uint32_t i = 0; i < starts.size(); ++i) {
            if (dot(sample.direction, starts[i].normal) <= 0.0f) continue;
            Ray ray;
            ray.origin = starts[i].origin;
            ray.direction = sample.direction;
            ray.skip = starts[i].skip;
            w.lanes[w.shadow_rays.size()] = i;
            w.shadow_rays.push_back(ray);
        }
        w.blocked.resize(w.shadow_rays.size());
        transport_.tracer.occluded(w.shadow_rays, w.blocked);
        for (std::size_t k = 0; k < w.blocked.size(); ++k)
            if (!w.blocked[k]) starts[w.lanes[k]].sunlit |= 1u << sun;
    }
}

namespace {

// Only the irradiance of each path, for pictures.
class IrradianceSink {
public:
    static constexpr bool kFromCell = false, kSunsKnown = false, kMayBeGuided = false;

    IrradianceSink(const PathOptions& options, std::span<const PathStart> starts, std::span<Vec3> irradiance,
                   std::span<std::uint8_t> met_back)
        : options_(options), starts_(starts), irradiance_(irradiance), met_back_(met_back) {
        std::fill(irradiance.begin(), irradiance.end(), Vec3{});
        std::fill(met_back.begin(), met_back.end(), std::uint8_t{0});
    }
    void back(std::uint32_t lane, float) {
        if (!met_back_.empty()) met_back_[lane] = 1;
    }
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
    std::span<std::uint8_t> met_back_;
};

}  // namespace

void PathIntegrator::gather_irradiance(std::span<const PathStart> starts, Workspace& workspace,
                                       std::span<Vec3> irradiance, std::span<std::uint8_t> met_back) const {
    LUMEL_CHECK(met_back.empty() || met_back.size() >= starts.size(), met_back.size(), starts.size());
    IrradianceSink sink(options_, starts, irradiance, met_back);
    trace_paths(starts, workspace, sink, {});
}

}  // namespace lumel
