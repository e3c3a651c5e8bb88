#include "render/picture.h"

#include <array>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/progress_parts.h"
#include "base/try.h"
#include "math/sampler.h"
#include "render/camera_rays.h"

namespace lumel {
namespace {

constexpr std::uint32_t kFilmPair = 0xf11u;    // pair of dimensions of the position in the pixel
constexpr std::uint64_t kPictureKey = 0x9c7u;  // keeps pixels' point sets apart from texels'

// The picture of one worker: up to kWavefrontLanes camera rays of one pixel at a time.
class PixelTracer {
public:
    PixelTracer(const Transport& transport, const PathIntegrator& integrator, const PathOptions& path, const Lens& lens,
                const PictureOptions& options, const BakedLight* baked)
        : transport_(transport),
          integrator_(integrator),
          path_(path),
          lens_(lens),
          options_(options),
          baked_(baked),
          workspace_(integrator.make_workspace()) {}

    Vec3 pixel(std::uint32_t x, std::uint32_t y) {
        const std::uint32_t key = pixel_key(x, y);
        Vec3 sum{}, lit{};
        for (std::uint32_t base = 0; base < options_.samples; base += kWavefrontLanes) {
            const std::uint32_t n = std::min<std::uint32_t>(kWavefrontLanes, options_.samples - base);
            see(x, y, key, base, n);
            std::uint32_t traced = 0;
            for (std::uint32_t i = 0; i < n; ++i) sum += shade(i, traced);
            lit += baked_light_;
            path_trace(key, base, traced, lit);
        }
        return (sum + lit) * (1.0f / static_cast<float>(options_.samples));
    }

    // The baked light alone.
    Vec3 further_light(std::uint32_t x, std::uint32_t y) {
        const std::uint32_t key = pixel_key(x, y);
        Vec3 lit{};
        for (std::uint32_t base = 0; base < options_.samples; base += kWavefrontLanes) {
            const std::uint32_t n = std::min<std::uint32_t>(kWavefrontLanes, options_.samples - base);
            see(x, y, key, base, n);
            std::uint32_t others = 0;
            for (std::uint32_t i = 0; i < n; ++i) shade(i, others);
            lit += baked_light_;
        }
        return lit * (1.0f / static_cast<float>(options_.samples));
    }

private:
    [[nodiscard]] std::uint32_t pixel_key(std::uint32_t x, std::uint32_t y) const {
        return sampler_key(path_.seed ^ (kPictureKey << 48), (std::uint64_t{y} << 32) | x);
    }

    // Nearest visible surfaces, back faces of single-sided ones culled.
    void see(std::uint32_t x, std::uint32_t y, std::uint32_t key, std::uint32_t base, std::uint32_t n) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const Sampler sampler(key, base + i);
            const Vec2 jitter = sampler.pair(kFilmPair);
            rays_[i] = lens_.ray(static_cast<float>(x) + jitter.x, static_cast<float>(y) + jitter.y);
            rays_[i].alpha_key = sampler.hash(kFilmPair);
        }
        transport_.tracer.closest(std::span(rays_).first(n), std::span(hits_).first(n));
        for (std::uint32_t i = 0; i < n; ++i) pass_culled(transport_.tracer, transport_.geometry, rays_[i], hits_[i]);
        baked_light_ = {};
    }

    // Emission or sky of sample i; queues its surface for path tracing unless the bake lights it.
    Vec3 shade(std::uint32_t i, std::uint32_t& traced) {
        const Hit& hit = hits_[i];
        if (hit.missed())
            return transport_.lights.has_sky() ? transport_.lights.sky(rays_[i].direction).radiance : Vec3{};
        if (is_culled(transport_.geometry, hit)) return {};
        const Vec3 albedo = transport_.surfaces.albedo(hit.triangle, hit.b1, hit.b2);
        const Vec3 emission = transport_.surfaces.emission(hit.triangle, hit.b1, hit.b2);
        if (baked_ && !hit.back_face)
            if (const std::optional<Vec3> irradiance = baked_->irradiance(hit.triangle, hit.b1, hit.b2)) {
                baked_light_ += albedo * *irradiance;
                return emission;
            }
        points_[traced] = {hit.triangle, hit.b1, hit.b2};
        sides_[traced] = hit.back_face;
        albedo_[traced] = albedo;
        lane_[traced] = i;
        ++traced;
        return emission;
    }

    void path_trace(std::uint32_t key, std::uint32_t base, std::uint32_t n, Vec3& lit) {
        if (n == 0) return;
        integrator_.surface_starts(std::span(points_).first(n), std::span(sides_).first(n), *workspace_, surface_);
        for (std::uint32_t k = 0; k < n; ++k)
            starts_[k] = {surface_[k].origin, surface_[k].normal, key, base + lane_[k], surface_[k].skip};
        integrator_.gather_irradiance(std::span(starts_).first(n), *workspace_, std::span(irradiance_).first(n));
        for (std::uint32_t k = 0; k < n; ++k) lit += albedo_[k] * irradiance_[k];
    }

    const Transport& transport_;
    const PathIntegrator& integrator_;
    const PathOptions& path_;
    const Lens& lens_;
    const PictureOptions& options_;
    const BakedLight* baked_;
    PathIntegrator::WorkspacePtr workspace_;

    std::array<Ray, kWavefrontLanes> rays_;
    std::array<Hit, kWavefrontLanes> hits_;
    std::array<SamplePoint, kWavefrontLanes> points_;
    std::array<std::uint8_t, kWavefrontLanes> sides_{};
    std::array<std::uint32_t, kWavefrontLanes> lane_{};
    std::array<Vec3, kWavefrontLanes> albedo_, irradiance_;
    std::array<SurfaceStart, kWavefrontLanes> surface_;
    std::array<PathStart, kWavefrontLanes> starts_;
    Vec3 baked_light_{};
};

}  // namespace

Camera look_at(Vec3 eye, Vec3 target, float vertical_fov) {
    Camera camera;
    const Vec3 back = normalize_or(eye - target, {0, 0, 1});
    const Vec3 right = normalize_or(cross({0, 1, 0}, back), {1, 0, 0});
    camera.transform = {{right, cross(back, right), back}, eye};
    camera.vertical_fov = vertical_fov;
    return camera;
}

Result<Image> render_picture(const Transport& transport, const PathOptions& path, const Camera& camera,
                             const PictureOptions& options, const BakedLight* baked, Context& context) {
    Image image(options.width, options.height, 3);
    const PathIntegrator integrator(transport, path);
    const Lens lens(camera, options.width, options.height);
    std::vector<std::unique_ptr<PixelTracer>> tracers(context.threads());
    for (auto& tracer : tracers)
        tracer = std::make_unique<PixelTracer>(transport, integrator, path, lens, options, baked);
    const std::uint32_t parts = baked ? baked->parts : 1;
    ProgressParts progress(context, "render", parts);
    for (std::uint32_t part = 0; part < parts; ++part) {
        progress.begin(1.0);
        if (baked && baked->load) LUMEL_TRY_STATUS(baked->load(part));
        const std::uint64_t rays_before = transport.tracer.statistics().rays;
        const bool done = parallel_for(
            context, std::size_t{options.width} * options.height, 32,
            [&](const ChunkRange& range) {
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    const auto x = static_cast<std::uint32_t>(i % options.width);
                    const auto y = static_cast<std::uint32_t>(i / options.width);
                    PixelTracer& tracer = *tracers[range.worker];
                    const Vec3 color = part > 0 ? tracer.further_light(x, y) : tracer.pixel(x, y);
                    for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] += color[c];
                }
            },
            "render", [&] { return transport.tracer.statistics().rays - rays_before; });
        if (!done) return cancelled_error();
    }
    return image;
}

}  // namespace lumel
