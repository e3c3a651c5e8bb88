#include "seed_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "light/light_set.h"
#include "math/sampler.h"

namespace lumel::bench {
namespace {

// Metres. The article's own bias, position * 2e-7, is none at all at a coordinate of zero, where floors often are: what
// is measured here is how leaks are kept out, not that.
constexpr float kBias = 1e-4f;

}  // namespace

SurfaceStart seed_sample(const BenchScene& bench, std::size_t texel) {
    const TexelBuffer& texels = bench.texels;
    const std::uint32_t triangle = texels.triangles[texels.first_triangle[texel]];
    const Vec3 normal = bench.geometry.geometric_normal(triangle);
    const Vec3 helper = std::fabs(normal.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 tangent = normalize(cross(normal, helper)), bitangent = cross(normal, tangent);
    const Vec3 position = texels.position[texel] + normal * kBias;
    SurfaceStart start{position, texels.normal[texel], triangle};
    std::array<Ray, 4> rays;
    std::array<Hit, 4> hits;
    const std::array<Vec3, 4> directions{tangent, -tangent, bitangent, -bitangent};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i].origin = position;
        rays[i].direction = directions[i];
        rays[i].tmax = 0.5f * std::sqrt(2.0f) * texels.world_size[texel];
        rays[i].skip = triangle;
    }
    bench.tracer->closest(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].missed() || !hits[i].back_face) continue;
        const Vec3 hit_normal = bench.geometry.geometric_normal(hits[i].triangle);
        start.origin = position + rays[i].direction * hits[i].t + hit_normal * kBias;
        break;
    }
    return start;
}

RadianceSums gather_seed_samples(const BenchScene& bench, std::uint32_t samples, Context& context) {
    const LightSet lights(bench.scene, bench.geometry, bench.surfaces);
    const Transport transport{bench.scene, bench.geometry, bench.surfaces, lights, *bench.tracer};
    PathOptions options;
    options.samples = samples;
    const PathIntegrator integrator(transport, options);
    std::vector<PathIntegrator::WorkspacePtr> workspaces(context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();
    RadianceSums sums;
    sums.resize(bench.texels.size());
    parallel_for(context, bench.texels.size(), 1, [&](const ChunkRange& range) {
        const SurfaceStart start = seed_sample(bench, range.begin);
        const std::uint32_t key = mix32(static_cast<std::uint32_t>(range.begin) + 1);
        std::array<PathStart, kWavefrontLanes> starts;
        std::array<Vec3, kWavefrontLanes> light;
        Vec3 sum{};
        for (std::uint32_t base = 0; base < samples; base += kWavefrontLanes) {
            const std::uint32_t lanes = std::min<std::uint32_t>(kWavefrontLanes, samples - base);
            for (std::uint32_t lane = 0; lane < lanes; ++lane)
                starts[lane] = {start.origin, start.normal, key, base + lane, start.skip};
            const auto batch = std::span<const PathStart>(starts).first(lanes);
            integrator.gather_irradiance(batch, *workspaces[range.worker], std::span(light).first(lanes));
            for (std::uint32_t lane = 0; lane < lanes; ++lane) sum += light[lane];
        }
        sums.layers[range.begin][static_cast<std::size_t>(Layer::direct)].irradiance =
            sum * (1.0f / static_cast<float>(samples));
        sums.open[range.begin] = sums.count[range.begin] = samples;
    });
    return sums;
}

}  // namespace lumel::bench
