// Viewpoints for pictures of scenes that bring no cameras.
#include <algorithm>
#include <array>
#include <cmath>

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
    // Look where the view is deepest: mean distance within 40 degrees of each ray.
    float best = -1.0f;
    for (std::uint32_t i = 0; i < kProbeRays; ++i) {
        if (hits[i].missed()) continue;
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

}  // namespace

std::vector<Camera> choose_views(const Scene& scene, const WorldGeometry& geometry, const Tracer& tracer,
                                 std::size_t count) {
    std::vector<Camera> views(scene.cameras.begin(), scene.cameras.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                                 count, scene.cameras.size())));
    const Vec3 size = geometry.bounds_max - geometry.bounds_min;
    const float diagonal = length(size);
    std::vector<Candidate> candidates;
    for (std::uint32_t i = 0; i < kCandidates; ++i) {
        const Sampler sampler(kKey, i);
        const Vec2 ground = sampler.pair(1);
        const Vec3 eye =
            geometry.bounds_min + Vec3{size.x * (0.04f + 0.92f * ground.x), size.y * (0.15f + 0.6f * sampler.one(2)),
                                       size.z * (0.04f + 0.92f * ground.y)};
        const Candidate candidate = look_around(eye, mix32(kKey + i), tracer, geometry, diagonal);
        if (candidate.score > 0.0f) candidates.push_back(candidate);
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    // A room is a place where many points see surfaces all around; else the scene is looked at from outside.
    const bool enclosed = candidates.size() * 8 >= kCandidates;
    std::vector<Vec3> eyes;
    for (const Camera& view : views) eyes.push_back(view.transform.translation);
    for (const float spacing : {0.3f, 0.15f, 0.05f}) {
        if (!enclosed) break;
        for (const Candidate& c : candidates) {
            if (views.size() >= count) break;
            const bool near = std::any_of(eyes.begin(), eyes.end(),
                                          [&](Vec3 eye) { return length(eye - c.eye) < spacing * diagonal; });
            if (near) continue;
            views.push_back(look_at(c.eye, c.target, kFieldOfView));
            eyes.push_back(c.eye);
        }
    }
    for (std::size_t corner = 0; views.size() < count; ++corner) views.push_back(overview(geometry, corner));
    for (std::size_t i = 0; i < views.size(); ++i)
        if (views[i].name.empty()) views[i].name = "view " + std::to_string(i);
    return views;
}

}  // namespace lumel
