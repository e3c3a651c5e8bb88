#include "seam/seam_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/parallel.h"

namespace lumel {
namespace {

// How far beside the seam its rays run, in half texels: as far as a bilinear lookup carries what is changed at the
// seam. A wall that stands on it is not seen by rays that begin inside.
constexpr std::array<float, 3> kReaches{1.0f, 2.0f, 3.0f};

struct Part {
    std::vector<SeamSample> samples;
    std::vector<Ray> rays;  // kReaches.size() per sample
    std::vector<std::uint8_t> blocked;
    double metres = 0.0;
    std::uint64_t hidden = 0;
};

// From above one side of the seam to above the other.
Ray ray_across(Vec3 from, Vec3 to) {
    Ray ray;
    ray.origin = from;
    ray.tmax = length(to - from);
    ray.direction = normalize_or(to - from, {0, 1, 0});
    return ray;
}

void sample_seam(std::span<const BorderEdge> edges, const Seam& seam, const SeamRule& rule, float per_texel,
                 Part& part) {
    const BorderEdge &a = edges[seam.a], &b = edges[seam.b];
    const float texels_a = length(texels_at(a, seam.a_to) - texels_at(a, seam.a_from));
    const float texels_b = length(texels_at(b, seam.b_to) - texels_at(b, seam.b_from));
    const float metres = length(position_at(a, seam.a_to) - position_at(a, seam.a_from));
    const float denser = std::max(texels_a, texels_b);
    part.metres += static_cast<double>(metres);
    const float reach = 0.5f * metres / std::max(denser, 1.0f);
    // At least one, so that of charts below a texel each side has a say.
    const auto n = static_cast<std::uint32_t>(std::ceil(std::max(1.0f, denser * per_texel)));
    const float weight = std::max(denser, 1.0f / per_texel) / static_cast<float>(n);
    for (std::uint32_t k = 0; k < n; ++k) {
        const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(n);
        const float on_a = std::lerp(seam.a_from, seam.a_to, t), on_b = std::lerp(seam.b_from, seam.b_to, t);
        const Vec3 normal_a = normal_at(a, on_a), normal_b = normal_at(b, on_b);
        if (dot(normal_a, normal_b) < rule.normal_cosine) continue;
        const Vec3 lift = normalize_or(normal_a + normal_b, normal_a) * reach;
        part.samples.push_back({{a.page, texels_at(a, on_a)}, {b.page, texels_at(b, on_b)}, weight});
        for (const float halves : kReaches)
            part.rays.push_back(ray_across(position_at(a, on_a) + a.inward * (halves * reach) + lift,
                                           position_at(b, on_b) + b.inward * (halves * reach) + lift));
    }
}

void drop_hidden(const Tracer& tracer, Part& part) {
    part.blocked.resize(part.rays.size());
    tracer.occluded(part.rays, part.blocked);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < part.samples.size(); ++i) {
        const auto blocked = std::span(part.blocked).subspan(i * kReaches.size(), kReaches.size());
        if (std::ranges::none_of(blocked, [](std::uint8_t b) { return b != 0; }))
            part.samples[kept++] = part.samples[i];
    }
    part.hidden = part.samples.size() - kept;
    part.samples.resize(kept);
    part.rays = {};
    part.blocked = {};
}

}  // namespace

Result<SeamSamples> make_seam_samples(std::span<const BorderEdge> edges, std::span<const Seam> seams,
                                      const SeamRule& rule, float per_texel, const Tracer& tracer, Context& context) {
    constexpr std::size_t kSeamsPerChunk = 1024;
    std::vector<Part> parts((seams.size() + kSeamsPerChunk - 1) / kSeamsPerChunk);
    const bool done = parallel_for(
        context, seams.size(), kSeamsPerChunk,
        [&](const ChunkRange& range) {
            Part& part = parts[range.index];
            for (std::size_t i = range.begin; i < range.end; ++i) sample_seam(edges, seams[i], rule, per_texel, part);
            drop_hidden(tracer, part);
        },
        "seams");
    if (!done) return cancelled_error();
    SeamSamples out;
    for (Part& part : parts) {
        out.samples.insert(out.samples.end(), part.samples.begin(), part.samples.end());
        out.metres += part.metres;
        out.hidden += part.hidden;
        part.samples = {};
    }
    return out;
}

}  // namespace lumel
