#include "leak_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "base/parallel.h"
#include "math/sampler.h"
#include "path/path_integrator.h"
#include "texel/texel_triangle.h"

namespace lumel::bench {
namespace {

constexpr float kLift = 0.04f;              // texels that short visibility rays run above the surface
constexpr float kAboveSurface = 2e-3f;      // metres, of the points that are asked whether they are hidden
constexpr std::size_t kSliver = kFineEdge;  // fine points: a texel of which no more are seen is judged by its lookups
constexpr std::uint32_t kHalves = 2;        // of the paths, independent: they tell the error

struct FinePoint {
    std::uint32_t x, y;  // on the fine grid of the page
    std::uint32_t chart;
    Vec3 lifted;
    SurfaceStart start;
    std::array<double, kHalves> sum{}, traced{};
    double met_back = 0.0;
    bool joined_right = false, joined_down = false;  // whether it sees that neighbour of its chart

    [[nodiscard]] bool is_hidden() const { return 2.0 * met_back > traced[0] + traced[1]; }
    [[nodiscard]] double mean() const { return (sum[0] + sum[1]) / std::max(1.0, traced[0] + traced[1]); }
};

class FineGrid {
public:
    FineGrid(const BenchScene& bench, const std::function<bool(Vec3)>& hidden, Context& context)
        : bench_(bench),
          lights_(bench.scene, bench.geometry, bench.surfaces),
          transport_{bench.scene, bench.geometry, bench.surfaces, lights_, *bench.tracer},
          width_(bench.texels.width * kFineEdge),
          height_(bench.texels.height * kFineEdge),
          at_(std::size_t{width_} * height_, kNone),
          first_(bench.texels.size() + 1),
          context_(context) {
        find_points(hidden);
        join_neighbours();
    }

    // Points more than half of whose paths meet backs first are inside something: they are left out.
    void light(std::uint32_t paths) {
        PathOptions options;
        options.samples = paths;
        const PathIntegrator integrator(transport_, options);
        std::vector<PathIntegrator::WorkspacePtr> workspaces(context_.threads());
        for (auto& workspace : workspaces) workspace = integrator.make_workspace();
        parallel_for(context_, bench_.texels.size(), 1, [&](const ChunkRange& range) {
            light_texel(range.begin, paths, integrator, *workspaces[range.worker]);
        });
        for (const FinePoint& p : points_)
            if (p.is_hidden()) at_[std::size_t{p.y} * width_ + p.x] = kNone;
    }

    [[nodiscard]] LeakReference evaluate() const {
        LeakReference out;
        double sum = 0.0, squares = 0.0;
        std::size_t visible = 0;
        for (const FinePoint& p : points_) {
            if (p.is_hidden()) continue;
            sum += p.mean();
            ++visible;
        }
        out.scene_mean = sum / static_cast<double>(std::max<std::size_t>(1, visible));
        std::size_t texels = 0;
        for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
            if (first_[i] == first_[i + 1]) continue;
            std::array<double, kHalves> total{}, count{};
            for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k)
                for (std::size_t half = 0; half < kHalves; ++half) {
                    total[half] += points_[k].sum[half];
                    count[half] += points_[k].traced[half];
                }
            const double difference = total[0] / std::max(1.0, count[0]) - total[1] / std::max(1.0, count[1]);
            squares += 0.25 * difference * difference;
            ++texels;
        }
        out.sigma = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, texels))) / out.scene_mean;
        out.pixels.resize(std::size_t{bench_.texels.width} * bench_.texels.height);
        for (std::uint32_t y = 0; y < bench_.texels.height; ++y)
            for (std::uint32_t x = 0; x < bench_.texels.width; ++x)
                out.pixels[std::size_t{y} * bench_.texels.width + x] = allowed(x, y);
        return out;
    }

private:
    void find_points(const std::function<bool(Vec3)>& hidden) {
        const TexelBuffer& texels = bench_.texels;
        PathOptions options;
        const PathIntegrator integrator(transport_, options);
        const PathIntegrator::WorkspacePtr workspace = integrator.make_workspace();
        for (std::uint32_t i = 0; i < texels.size(); ++i) {
            first_[i] = static_cast<std::uint32_t>(points_.size());
            std::vector<TexelTriangle> triangles;
            const std::uint32_t begin = texels.first_triangle[i], end = texels.first_triangle[i + 1];
            for (std::uint32_t k = begin; k < end; ++k)
                triangles.emplace_back(
                    bench_.atlas.triangle_uv(bench_.charts, bench_.geometry, bench_.scene, texels.triangles[k]).texels);
            for (std::uint32_t s = 0; s < kFineEdge * kFineEdge; ++s) {
                const std::uint32_t x = texels.x[i] * kFineEdge + s % kFineEdge;
                const std::uint32_t y = texels.y[i] * kFineEdge + s / kFineEdge;
                for (std::uint32_t k = begin; k < end; ++k) {
                    const auto b = triangles[k - begin].locate((x + 0.5) / kFineEdge, (y + 0.5) / kFineEdge);
                    if (!b) continue;
                    add_point(x, y, i, {texels.triangles[k], b->b1, b->b2}, hidden, integrator, *workspace);
                    break;
                }
            }
        }
        first_.back() = static_cast<std::uint32_t>(points_.size());
    }

    void add_point(std::uint32_t x, std::uint32_t y, std::uint32_t texel, SamplePoint point,
                   const std::function<bool(Vec3)>& hidden, const PathIntegrator& integrator,
                   PathIntegrator::Workspace& workspace) {
        const Vec3 p = bench_.geometry.position(point.triangle, point.b1, point.b2);
        const Vec3 n = bench_.geometry.geometric_normal(point.triangle);
        if (hidden(p + n * kAboveSurface)) return;
        FinePoint fine{x, y, bench_.texels.chart[texel], p + n * (kLift * bench_.texels.world_size[texel]), {}};
        const std::uint8_t front = 0;
        integrator.surface_starts(std::span(&point, 1), std::span(&front, 1), workspace, std::span(&fine.start, 1));
        at_[std::size_t{y} * width_ + x] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(fine);
    }

    [[nodiscard]] std::uint32_t at(std::uint32_t x, std::uint32_t y) const {
        return x < width_ && y < height_ ? at_[std::size_t{y} * width_ + x] : kNone;
    }

    [[nodiscard]] bool sees(const FinePoint& a, std::uint32_t b) const {
        if (b == kNone || points_[b].chart != a.chart) return false;
        const Vec3 d = points_[b].lifted - a.lifted;
        const float distance = length(d);
        if (!(distance > 0.0f)) return true;
        Ray ray;
        ray.origin = a.lifted;
        ray.direction = d / distance;
        ray.tmax = distance;
        std::uint8_t blocked = 0;
        bench_.tracer->occluded(std::span(&ray, 1), std::span(&blocked, 1));
        return blocked == 0;
    }

    void join_neighbours() {
        for (FinePoint& p : points_) {
            p.joined_right = sees(p, at(p.x + 1, p.y));
            p.joined_down = sees(p, at(p.x, p.y + 1));
        }
    }

    void light_texel(std::size_t texel, std::uint32_t paths, const PathIntegrator& integrator,
                     PathIntegrator::Workspace& workspace) {
        const std::uint32_t first = first_[texel], n = first_[texel + 1] - first;
        if (n == 0) return;
        std::array<PathStart, kWavefrontLanes> starts;
        std::array<Vec3, kWavefrontLanes> light;
        std::array<std::uint8_t, kWavefrontLanes> met_back;
        for (std::uint32_t half = 0; half < kHalves; ++half) {
            const std::uint32_t key = mix32(static_cast<std::uint32_t>(texel) * kHalves + half + 1);
            for (std::uint32_t base = 0; base < paths / kHalves; base += kWavefrontLanes) {
                for (std::uint32_t lane = 0; lane < kWavefrontLanes; ++lane) {
                    const SurfaceStart& start = points_[first + (base + lane) % n].start;
                    starts[lane] = {start.origin, start.normal, key, base + lane, start.skip};
                }
                integrator.gather_irradiance(starts, workspace, light, met_back);
                for (std::uint32_t lane = 0; lane < kWavefrontLanes; ++lane) {
                    FinePoint& p = points_[first + (base + lane) % n];
                    p.sum[half] += static_cast<double>(luminance(light[lane]));
                    p.traced[half] += 1.0;
                    p.met_back += met_back[lane];
                }
            }
        }
    }

    // A group of points of a window of the page that are joined within it.
    struct Group {
        std::size_t size = 0;
        double light = 0.0, weight = 0.0;
    };

    template <class Weight>
    [[nodiscard]] std::vector<Group> groups(std::int32_t left, std::int32_t top, std::int32_t edge, std::uint32_t chart,
                                            Weight&& weight) const {
        std::vector<std::uint32_t> inside;
        for (std::int32_t y = std::max(0, top); y < top + edge; ++y)
            for (std::int32_t x = std::max(0, left); x < left + edge; ++x) {
                const std::uint32_t p = at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
                if (p != kNone && (chart == kNone || points_[p].chart == chart)) inside.push_back(p);
            }
        std::map<std::uint32_t, std::uint32_t> parent;
        for (const std::uint32_t p : inside) parent[p] = p;
        const auto root = [&](std::uint32_t p) {
            while (parent[p] != p) p = parent[p];
            return p;
        };
        const auto join = [&](std::uint32_t a, std::uint32_t b) {
            if (parent.contains(b)) parent[root(b)] = root(a);
        };
        for (const std::uint32_t p : inside) {
            if (points_[p].joined_right) join(p, at(points_[p].x + 1, points_[p].y));
            if (points_[p].joined_down) join(p, at(points_[p].x, points_[p].y + 1));
        }
        std::map<std::uint32_t, Group> found;
        for (const std::uint32_t p : inside) {
            Group& group = found[root(p)];
            const double w = weight(points_[p]);
            ++group.size;
            group.weight += w;
            group.light += w * points_[p].mean();
        }
        std::vector<Group> out;
        for (const auto& [_, group] : found) out.push_back(group);
        return out;
    }

    [[nodiscard]] AllowedLight allowed(std::uint32_t x, std::uint32_t y) const {
        AllowedLight out;
        const auto left = static_cast<std::int32_t>(x * kFineEdge), top = static_cast<std::int32_t>(y * kFineEdge);
        const auto own = groups(left, top, kFineEdge, kNone, [](const FinePoint&) { return 1.0; });
        std::size_t largest = 0;
        for (const Group& g : own) largest = std::max(largest, g.size);
        for (const Group& g : own)
            if (largest > kSliver && g.size + kFineEdge >= largest)
                out.means.push_back(static_cast<float>(g.light / g.weight));
        out.own = !out.means.empty();
        if (out.own) return out;
        const auto half = static_cast<std::int32_t>(kFineEdge / 2), edge = static_cast<std::int32_t>(2 * kFineEdge);
        const double middle_x = left + half, middle_y = top + half;
        const auto bilinear = [&](const FinePoint& p) {
            const double dx = std::fabs(p.x + 0.5 - middle_x) / kFineEdge,
                         dy = std::fabs(p.y + 0.5 - middle_y) / kFineEdge;
            return std::max(0.0, 1.0 - dx) * std::max(0.0, 1.0 - dy);
        };
        for (const Group& g : groups(left - half, top - half, edge, kNone, bilinear))
            if (g.weight > 0.0) out.means.push_back(static_cast<float>(g.light / g.weight));
        return out;
    }

    const BenchScene& bench_;
    LightSet lights_;
    Transport transport_;
    std::uint32_t width_, height_;
    std::vector<FinePoint> points_;     // visible ones, by texel
    std::vector<std::uint32_t> at_;     // per fine pixel: into points_, or kNone
    std::vector<std::uint32_t> first_;  // per texel into points_, plus one past the end
    Context& context_;
};

}  // namespace

LeakReference leak_reference(const BenchScene& bench, const std::function<bool(Vec3)>& hidden, std::uint32_t paths,
                             Context& context) {
    FineGrid grid(bench, hidden, context);
    grid.light(paths);
    return grid.evaluate();
}

}  // namespace lumel::bench
