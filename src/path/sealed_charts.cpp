#include "path/sealed_charts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/try.h"
#include "chart/density.h"
#include "math/sampler.h"

namespace lumel {
namespace {

constexpr std::uint64_t kSealedKey = 0x5ea1u;  // of the random numbers: the same layout for any seed
constexpr std::uint32_t kStride = 1597;        // odd: visits all strata of a chart, far apart ones first
static_assert(kSealedPaths % kWavefrontLanes == 0 && (kSealedPaths & (kSealedPaths - 1)) == 0);

// Points of a chart, evenly spread over its surface.
class ChartPoints {
public:
    ChartPoints(const Transport& transport, const ChartSet& charts, const ChartInstance& which) {
        const MeshCharts& mesh = charts.meshes[which.mesh];
        const Chart& chart = mesh.charts[which.chart];
        const std::uint32_t first = transport.geometry.first_triangle[which.instance];
        for (std::uint32_t k = chart.first; k < chart.first + chart.count; ++k) {
            triangles_.push_back(first + mesh.order[k]);
            area_ += static_cast<double>(transport.geometry.area(triangles_.back()));
            area_up_to_.push_back(area_);
        }
    }
    [[nodiscard]] double area() const { return area_; }

    // `along`, 0..1, goes through the chart triangle by triangle.
    [[nodiscard]] SamplePoint at(double along, Vec2 inside) const {
        const auto it = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, along * area_);
        const float root = std::sqrt(inside.x);
        return {triangles_[static_cast<std::size_t>(it - area_up_to_.begin())], root * (1.0f - inside.y),
                root * inside.y};
    }

private:
    std::vector<std::uint32_t> triangles_;
    std::vector<double> area_up_to_;
    double area_ = 0.0;
};

struct Scratch {
    PathIntegrator::WorkspacePtr workspace;
    std::array<SamplePoint, kWavefrontLanes> points;
    std::array<std::uint8_t, kWavefrontLanes> front_side{};
    std::array<SurfaceStart, kWavefrontLanes> surface;
    std::array<PathStart, kWavefrontLanes> starts;
    std::array<Vec3, kWavefrontLanes> irradiance;
};

bool is_sealed(const ChartPoints& points, std::uint32_t key, const PathIntegrator& integrator, Scratch& s) {
    std::uint32_t found = 0;
    for (std::uint32_t base = 0; base < kSealedPaths; base += kWavefrontLanes) {
        for (std::uint32_t i = 0; i < kWavefrontLanes; ++i) {
            const std::uint32_t stratum = ((base + i) * kStride) % kSealedPaths;
            const std::uint32_t a = mix32(key + stratum), b = mix32(a ^ 0x9e3779b9u), c = mix32(b ^ 0x85ebca6bu);
            const double along = (stratum + static_cast<double>(unit_float(a))) / kSealedPaths;
            s.points[i] = points.at(along, {unit_float(b), unit_float(c)});
        }
        integrator.surface_starts(s.points, s.front_side, *s.workspace, s.surface);
        for (std::uint32_t i = 0; i < kWavefrontLanes; ++i)
            s.starts[i] = {s.surface[i].origin, s.surface[i].normal, key, base + i, s.surface[i].skip};
        integrator.gather_irradiance(s.starts, *s.workspace, s.irradiance);
        for (const Vec3& light : s.irradiance) found += light.x + light.y + light.z > 0.0f ? 1 : 0;
        if (found > kSealedPathsThatFind) return false;
    }
    return true;
}

}  // namespace

Result<std::vector<std::vector<bool>>> find_sealed_charts(const ChartSet& charts, double texel_budget,
                                                          const Transport& transport, Context& context) {
    const std::vector<ChartInstance> instances = chart_instances(transport.scene, charts);
    const double area = texels_at_unit_density(charts, instances);
    const PathOptions looking;  // whatever the bake will show of the light, how, and with which random numbers
    const PathIntegrator integrator(transport, looking);
    std::vector<Scratch> scratch(context.threads());
    for (Scratch& s : scratch) s.workspace = integrator.make_workspace();

    std::vector<std::uint8_t> sealed(instances.size());
    const std::uint64_t rays_before = transport.tracer.statistics().rays;
    const bool done = parallel_for(
        context, instances.size(), 4,
        [&](const ChunkRange& range) {
            for (std::size_t k = range.begin; k < range.end && !context.cancelled(); ++k) {
                const ChartPoints points(transport, charts, instances[k]);
                const double scale = transport.scene.instances[instances[k].instance].density_scale;
                if (points.area() * scale * scale * texel_budget < kTexelsWorthSealing * area) continue;
                sealed[k] = is_sealed(points, sampler_key(kSealedKey, k), integrator, scratch[range.worker]);
            }
        },
        "sealed", [&] { return transport.tracer.statistics().rays - rays_before; });
    if (!done || context.cancelled()) return cancelled_error();

    std::vector<std::vector<bool>> out(transport.scene.instances.size());
    for (std::size_t k = 0; k < instances.size(); ++k) {
        std::vector<bool>& of_instance = out[instances[k].instance];
        if (of_instance.empty()) of_instance.resize(charts.meshes[instances[k].mesh].charts.size());
        of_instance[instances[k].chart] = sealed[k] != 0;
    }
    return out;
}

}  // namespace lumel
