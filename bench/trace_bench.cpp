// Rays per CPU second of one thread, by kind of ray and by order:
//   incoherent  random surface point, cosine-weighted direction
//   sorted      the same rays in Morton order of their origins
//   texel       64 rays from one surface point
// `closest` asks for the nearest hit; `occluded` goes to a random point 1..5 m away, for `light` all 64 rays of a texel
// to points of one square metre.
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "bench.h"
#include "load.h"
#include "math/frame.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/surface.h"
#include "texel/ray_offset.h"
#include "trace/tracer.h"

namespace lumel::bench {
namespace {

struct Point {
    Vec3 position, normal;
};

// Uniform over the area of the scene.
class SurfaceSampler {
public:
    explicit SurfaceSampler(const WorldGeometry& geometry) : geometry_(geometry), sums_(geometry.triangle_count()) {
        double sum = 0;
        for (std::uint32_t t = 0; t < sums_.size(); ++t) sums_[t] = sum += static_cast<double>(geometry.area(t));
    }
    [[nodiscard]] Point sample(std::uint32_t index) const {
        const Sampler sampler(1, index);
        const double at = static_cast<double>(sampler.one(0)) * sums_.back();
        const auto found = std::upper_bound(sums_.begin(), sums_.end(), at);
        const auto t = static_cast<std::uint32_t>(
            std::min<std::ptrdiff_t>(found - sums_.begin(), static_cast<std::ptrdiff_t>(sums_.size()) - 1));
        const Vec2 b = UniformTriangle::sample(sampler.pair(1));
        const Vec3 n = geometry_.geometric_normal(t);
        return {offset_origin(geometry_, t, b.x, b.y, n), n};
    }

private:
    const WorldGeometry& geometry_;
    std::vector<double> sums_;
};

// Bits of three 10-bit numbers interleaved.
std::uint32_t morton(Vec3 unit) {
    std::uint32_t code = 0;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::uint32_t>(std::clamp(unit[axis] * 1024.0f, 0.0f, 1023.0f));
        for (std::uint32_t bit = 0; bit < 10; ++bit) code |= ((cell >> bit) & 1u) << (3 * bit + axis);
    }
    return code;
}

std::vector<Ray> gather_rays(const SurfaceSampler& surface, std::uint32_t count, std::uint32_t per_point) {
    std::vector<Ray> rays(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Point p = surface.sample(i / per_point);
        rays[i].origin = p.position;
        const Sampler sampler(2 + i / per_point, i % per_point);
        rays[i].direction = normalize(Frame(p.normal).to_world(CosineHemisphere::sample(sampler.pair(0))));
    }
    return rays;
}

std::vector<Ray> sorted_by_origin(const std::vector<Ray>& rays, const WorldGeometry& geometry) {
    const Vec3 size = max(geometry.bounds_max - geometry.bounds_min, Vec3{1e-20f, 1e-20f, 1e-20f});
    std::vector<std::uint32_t> key(rays.size()), order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3 p = rays[i].origin - geometry.bounds_min;
        key[i] = morton({p.x / size.x, p.y / size.y, p.z / size.z});
    }
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
    std::vector<Ray> out;
    out.reserve(rays.size());
    for (const std::uint32_t i : order) out.push_back(rays[i]);
    return out;
}

std::vector<Ray> shadow_rays(std::vector<Ray> rays) {
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].tmax = 1.0f + 4.0f * Sampler(3, static_cast<std::uint32_t>(i)).one(0);
    return rays;
}

std::vector<Ray> light_rays(const SurfaceSampler& surface, std::uint32_t count) {
    std::vector<Ray> rays = gather_rays(surface, count, 64);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Ray& first = rays[i / 64 * 64];
        const Vec2 u = Sampler(4, i).pair(0);
        const Vec3 light = first.origin + first.direction * 3.0f + Vec3{u.x - 0.5f, 0.0f, u.y - 0.5f};
        const Vec3 way = light - rays[i].origin;
        rays[i].direction = normalize(way);
        rays[i].tmax = length(way);
    }
    return rays;
}

struct Options {
    std::string scene;
    std::uint32_t rays = 1u << 20;
    std::uint32_t batch = 64;
    int repeats = 5;
};

// Best of the repeats: the machine's other work only ever takes time.
double best_seconds(int repeats, const auto& run) {
    double best = 1e30;
    for (int i = 0; i < repeats; ++i) {
        const CpuStopwatch stopwatch;
        run();
        best = std::min(best, stopwatch.seconds());
    }
    return best;
}

void run_trace(const Options& options) {
    Context context(1);
    const LoadedScene loaded = need(load_scene(options.scene, context));
    const WorldGeometry geometry = need(flatten(loaded.scene, context));
    const CpuStopwatch build;
    const auto tracer = need(make_embree_tracer(geometry, SurfaceReader(loaded.scene, geometry), context));
    const double build_seconds = build.seconds();
    std::fprintf(stderr, "# %s, %u triangles, built in %.2f CPU s\n", std::string(tracer->description()).c_str(),
                 geometry.triangle_count(), build_seconds);

    const SurfaceSampler surface(geometry);
    const auto incoherent = gather_rays(surface, options.rays, 1);
    const auto sorted = sorted_by_origin(incoherent, geometry);
    const auto texel = gather_rays(surface, options.rays, 64);

    std::printf("scene,triangles,query,order,batch,mrays_per_cpu_second\n");
    const auto print = [&](const char* query, const char* order, double seconds) {
        std::printf("%s,%u,%s,%s,%u,%.3f\n", base_name(options.scene).c_str(), geometry.triangle_count(), query, order,
                    options.batch, 1e-6 * options.rays / seconds);
    };
    const auto in_batches = [&](const std::vector<Ray>& rays, const auto& query) {
        for (std::size_t first = 0; first < rays.size(); first += options.batch)
            query(first, std::min<std::size_t>(options.batch, rays.size() - first));
    };
    const auto closest = [&](const char* order, const std::vector<Ray>& rays) {
        std::vector<Hit> hits(rays.size());
        print("closest", order, best_seconds(options.repeats, [&] {
                  in_batches(rays, [&](std::size_t first, std::size_t count) {
                      tracer->closest(std::span(rays).subspan(first, count), std::span(hits).subspan(first, count));
                  });
              }));
    };
    const auto occluded = [&](const char* order, const std::vector<Ray>& rays) {
        std::vector<std::uint8_t> blocked(rays.size());
        print("occluded", order, best_seconds(options.repeats, [&] {
                  in_batches(rays, [&](std::size_t first, std::size_t count) {
                      tracer->occluded(std::span(rays).subspan(first, count), std::span(blocked).subspan(first, count));
                  });
              }));
    };
    closest("incoherent", incoherent);
    closest("sorted", sorted);
    closest("texel", texel);
    occluded("incoherent", shadow_rays(incoherent));
    occluded("sorted", shadow_rays(sorted));
    occluded("texel", shadow_rays(texel));
    occluded("light", light_rays(surface, options.rays));
}

}  // namespace

void add_trace(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("trace", "Rays per CPU second of one thread");
    command->add_option("scene", options->scene, ".glb or .gltf")->required()->check(CLI::ExistingFile);
    command->add_option("--rays", options->rays, "Rays per measurement")->check(CLI::Range(64u, 1u << 26));
    command->add_option("--batch", options->batch, "Rays per call")->check(CLI::Range(1u, 1u << 20));
    command->add_option("--repeats", options->repeats, "The best of so many is printed")->check(CLI::Range(1, 100));
    command->callback([options] { run_trace(*options); });
}

}  // namespace lumel::bench
