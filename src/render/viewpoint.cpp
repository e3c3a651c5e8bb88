// Viewpoints for pictures of scenes that bring no cameras.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/try.h"
#include "math/constants.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "render/picture.h"

namespace lumel {
namespace {

constexpr std::uint32_t kCandidates = 192;
constexpr std::uint32_t kProbeRays = 64;
constexpr float kFieldOfView = 60.0f * kPi / 180.0f;
constexpr std::uint32_t kKey = 0x5eed;
constexpr float kHighest = 0.0f;  // sine of how far a view may look up: ceilings and sky show little of a bake

struct Candidate {
    Vec3 eye, target;
    float score = 0.0f;
};

// What there is to see around a point: score 0 where it is inside a solid or sees mostly back faces or nothing.
Candidate look_around(Vec3 eye, std::uint32_t key, const Tracer& tracer, const WorldGeometry& geometry,
                      float diagonal) {
    std::array<Ray, kProbeRays> rays;
    std::array<Hit, kProbeRays> hits;
    for (std::uint32_t i = 0; i < kProbeRays; ++i) {
        const Vec2 u = Sampler(key, i).pair(0);
        const Vec3 d = direction_from_z(1.0f - 2.0f * u.x, u.y);
        rays[i].origin = eye;
        rays[i].direction = {d.x, 0.35f * d.z, d.y};  // mostly level
        rays[i].direction = normalize(rays[i].direction);
    }
    tracer.closest(rays, hits);
    Candidate out{eye, eye, 0.0f};
    std::uint32_t front = 0;
    float nearest = kInfiniteDistance;
    for (const Hit& hit : hits) {
        if (hit.missed()) continue;
        nearest = std::min(nearest, hit.t);
        if (hit.back_face && !(geometry.triangles[hit.triangle].flags & kDoubleSided)) continue;
        ++front;
    }
    if (front < kProbeRays / 2 || nearest < 0.004f * diagonal) return out;
    // Look where the view is deepest, level or downwards: mean distance within 40 degrees of each ray.
    float best = -1.0f;
    for (std::uint32_t i = 0; i < kProbeRays; ++i) {
        if (hits[i].missed() || rays[i].direction.y > kHighest) continue;
        float sum = 0.0f, n = 0.0f;
        for (std::uint32_t k = 0; k < kProbeRays; ++k) {
            if (dot(rays[i].direction, rays[k].direction) < 0.77f) continue;
            n += 1.0f;
            if (!hits[k].missed()) sum += std::min(hits[k].t, diagonal);
        }
        if (sum / n > best) {
            best = sum / n;
            out.target = eye + rays[i].direction * hits[i].t;
        }
    }
    out.score = best * (0.5f + 0.5f * static_cast<float>(front) / kProbeRays);
    return out;
}

// From above a corner of the bounding box, towards its middle.
Camera overview(const WorldGeometry& geometry, std::size_t corner) {
    const Vec3 centre = (geometry.bounds_min + geometry.bounds_max) * 0.5f;
    const Vec3 size = geometry.bounds_max - geometry.bounds_min;
    const float sx = corner & 1 ? -1.0f : 1.0f;
    const float sz = corner & 2 ? -1.0f : 1.0f;
    const float reach = 0.62f * length(size);
    const Vec3 eye = centre + normalize(Vec3{sx * 0.8f, 0.75f, sz}) * (reach / std::tan(0.5f * kFieldOfView));
    return look_at(eye, centre, kFieldOfView);
}

// Points among surfaces, by falling score; none where few points see surfaces all around: that scene is open and looked
// at from outside.
std::vector<Candidate> find_candidates(const Transport& transport) {
    const WorldGeometry& geometry = transport.geometry;
    const Vec3 size = geometry.bounds_max - geometry.bounds_min;
    std::vector<Candidate> out;
    for (std::uint32_t i = 0; i < kCandidates; ++i) {
        const Sampler sampler(kKey, i);
        const Vec2 ground = sampler.pair(1);
        const Vec3 eye =
            geometry.bounds_min + Vec3{size.x * (0.04f + 0.92f * ground.x), size.y * (0.15f + 0.6f * sampler.one(2)),
                                       size.z * (0.04f + 0.92f * ground.y)};
        const Candidate candidate = look_around(eye, mix32(kKey + i), transport.tracer, geometry, length(size));
        if (candidate.score > 0.0f) out.push_back(candidate);
    }
    if (out.size() * 8 < kCandidates) return {};
    std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    return out;
}

// A thumbnail from each of the best candidates: those that see much less light than the brightest half are dropped
// (cavities inside walls, closed rooms without a lamp).
Result<std::vector<Candidate>> keep_lit(const Transport& transport, std::vector<Candidate> candidates,
                                        Context& context) {
    constexpr std::size_t kThumbnails = 48;
    constexpr PictureOptions kThumbnail{8, 6, 4};
    constexpr float kDim = 0.05f;
    candidates.resize(std::min(candidates.size(), kThumbnails));
    PathOptions path;
    path.bounces = 8;
    std::vector<float> light;
    for (const Candidate& c : candidates) {
        LUMEL_TRY(const Image image, render_picture(transport, path, look_at(c.eye, c.target, kFieldOfView), kThumbnail,
                                                    nullptr, context));
        // The median: one bright window does not light a room.
        std::vector<float> luminances;
        for (std::size_t i = 0; i < image.data.size(); i += 3)
            luminances.push_back(luminance({image.data[i], image.data[i + 1], image.data[i + 2]}));
        std::nth_element(luminances.begin(), luminances.begin() + 24, luminances.end());
        light.push_back(luminances[24]);
    }
    std::vector<float> sorted = light;
    std::sort(sorted.begin(), sorted.end());
    std::vector<Candidate> lit;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (light[i] > kDim * sorted[sorted.size() * 3 / 4]) lit.push_back(candidates[i]);
    return lit;
}

// The best of them that keep their distance from each other and from the views there are.
void add_spread(const std::vector<Candidate>& candidates, float diagonal, std::size_t count,
                std::vector<Camera>& views) {
    for (const float spacing : {0.3f, 0.15f, 0.05f})
        for (const Candidate& c : candidates) {
            if (views.size() >= count) return;
            const bool near = std::any_of(views.begin(), views.end(), [&](const Camera& view) {
                return length(view.transform.translation - c.eye) < spacing * diagonal;
            });
            if (!near) views.push_back(look_at(c.eye, c.target, kFieldOfView));
        }
}

}  // namespace

Result<std::vector<Camera>> choose_views(const Transport& transport, std::size_t count, Context& context) {
    const Scene& scene = transport.scene;
    const WorldGeometry& geometry = transport.geometry;
    std::vector<Camera> views(scene.cameras.begin(), scene.cameras.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                                 count, scene.cameras.size())));
    if (views.size() < count) {
        const std::vector<Candidate> candidates = find_candidates(transport);
        LUMEL_TRY(const std::vector<Candidate> lit, keep_lit(transport, candidates, context));
        add_spread(lit, length(geometry.bounds_max - geometry.bounds_min), count, views);
    }
    for (std::size_t corner = 0; views.size() < count; ++corner) views.push_back(overview(geometry, corner));
    for (std::size_t i = 0; i < views.size(); ++i)
        if (views[i].name.empty()) views[i].name = "view " + std::to_string(i);
    return views;
}

}  // namespace lumel
