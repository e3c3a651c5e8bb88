#include "path/visible_starts.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/check.h"
#include "math/frame.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "path/enclosed_points.h"

namespace lumel {
namespace {

constexpr std::uint32_t kGridEdge = 8;  // one Hammersley point in each of 8 x 8 cells of the texel
constexpr std::size_t kFewProbes = 16;  // of the points, spread evenly, that are asked before the rest
// How points are parted, at first and, where nothing is open then, again. `lift`: texels that short rays run above the
// surface: over its own bumps, or closer to it, where they look over the edge of a solid that it slants into. A place
// lies behind a surface where a larger share of its rays than `most_backs` meet near backs: the closer look may
// leave points on the wrong side of such an edge.
struct Parting {
    float lift, most_backs;
};
constexpr Parting kPartings[] = {{0.05f, 0.03f}, {0.002f, 0.12f}};
constexpr int kFewPoints = 16;  // that do not stand well for a component

std::uint32_t cell_of(std::uint32_t s) {
    const Vec2 p = subtexel_point(s);
    return static_cast<std::uint32_t>(p.y * kGridEdge) * kGridEdge + static_cast<std::uint32_t>(p.x * kGridEdge);
}

// The points of a texel by the cells they lie in.
struct PointGrid {
    static constexpr std::uint8_t kEmpty = 0xff;
    std::array<std::uint8_t, kGridEdge * kGridEdge> point;

    PointGrid(std::uint64_t valid, std::size_t n) {
        point.fill(kEmpty);
        for (std::size_t i = 0; i < n && valid != 0; ++i, valid &= valid - 1)
            point[cell_of(static_cast<std::uint32_t>(std::countr_zero(valid)))] = static_cast<std::uint8_t>(i);
    }

    // Calls visit(a, b) for the first and the last point of each row and each column of cells.
    template <class Visit>
    void for_each_line(Visit&& visit) const {
        for (const auto& [along, across] : {std::pair{1u, kGridEdge}, std::pair{kGridEdge, 1u}})
            for (std::uint32_t line = 0; line < kGridEdge; ++line) {
                std::uint8_t first = kEmpty, last = kEmpty;
                for (std::uint32_t k = 0; k < kGridEdge; ++k) {
                    const std::uint8_t p = point[line * across + k * along];
                    if (p == kEmpty) continue;
                    if (first == kEmpty) first = p;
                    last = p;
                }
                if (first != last) visit(first, last);
            }
    }

    // For all points whose cells share a side.
    template <class Visit>
    void for_each_pair(Visit&& visit) const {
        for (std::uint32_t y = 0; y < kGridEdge; ++y)
            for (std::uint32_t x = 0; x < kGridEdge; ++x) {
                const std::uint8_t p = point[y * kGridEdge + x];
                if (p == kEmpty) continue;
                if (x + 1 < kGridEdge && point[y * kGridEdge + x + 1] != kEmpty) visit(p, point[y * kGridEdge + x + 1]);
                if (y + 1 < kGridEdge && point[(y + 1) * kGridEdge + x] != kEmpty)
                    visit(p, point[(y + 1) * kGridEdge + x]);
            }
    }
};

Vec3 lifted(const SurfaceStart& start, const VisibleStarts::Points& points, float lift) {
    return start.origin + start.normal * (lift * points.texel_size);
}

// Their own triangles do not part the points: a chord of a curved surface runs below it.
bool parts(const Hit& hit, const VisibleStarts::Points& points) {
    return !hit.missed() && !std::ranges::binary_search(points.triangles, hit.triangle);
}

Ray segment(Vec3 from, Vec3 to) {
    Ray ray;
    const Vec3 d = to - from;
    ray.origin = from;
    ray.tmax = length(d);
    ray.direction = normalize_or(d, {0, 1, 0});
    return ray;
}

std::uint64_t first_bits(std::size_t n) { return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1; }

}  // namespace

class VisibleStarts::Components {
public:
    explicit Components(std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) root_[i] = static_cast<std::uint8_t>(i);
    }
    void join(std::uint8_t a, std::uint8_t b) { root_[root(a)] = root(b); }
    [[nodiscard]] std::uint8_t root(std::uint8_t i) const {
        while (root_[i] != i) i = root_[i];
        return i;
    }

private:
    std::array<std::uint8_t, kSamplesPerTexel> root_{};
};

VisibleStarts::VisibleStarts(const Tracer& tracer, const WorldGeometry& geometry, std::span<Ray> rays,
                             std::span<Hit> hits)
    : tracer_(tracer), geometry_(geometry), rays_(rays), hits_(hits) {
    LUMEL_CHECK(rays.size() >= 256 && hits.size() >= 256, rays.size(), hits.size());
}

void VisibleStarts::look_around(std::span<const SurfaceStart> starts, std::size_t first, std::uint32_t key) const {
    for (std::size_t i = first; i < starts.size(); ++i) {
        const Sampler sampler(key, static_cast<std::uint32_t>(i));
        Ray& ray = rays_[i] = {};
        ray.origin = starts[i].origin;
        ray.direction = Frame(starts[i].normal).to_world(GatherHemisphere::sample(sampler.pair(0)));
        ray.skip = starts[i].skip;
        ray.alpha_key = sampler.hash(1);
    }
    const std::size_t count = starts.size() - first;
    tracer_.closest(rays_.subspan(first, count), hits_.subspan(first, count));
}

bool VisibleStarts::is_single_sided_back(const Hit& hit) const {
    return !hit.missed() && hit.back_face && (geometry_.triangles[hit.triangle].flags & kDoubleSided) == 0;
}

bool VisibleStarts::is_near_back(const Hit& hit, const Points& points) const {
    return hit.t <= kEnclosureReach * points.texel_size && is_single_sided_back(hit);
}

bool VisibleStarts::rows_are_free(const Points& points, std::span<const SurfaceStart> starts, float lift) const {
    std::size_t count = 0;
    PointGrid(points.valid, starts.size()).for_each_line([&](std::uint8_t a, std::uint8_t b) {
        rays_[count++] = segment(lifted(starts[a], points, lift), lifted(starts[b], points, lift));
    });
    tracer_.closest(rays_.first(count), hits_.first(count));
    return std::ranges::none_of(hits_.first(count), [&](const Hit& hit) { return parts(hit, points); });
}

bool VisibleStarts::all_open(const Points& points, std::span<const SurfaceStart> starts, std::uint32_t key) const {
    const std::size_t probes = std::min(starts.size(), kFewProbes);
    look_around(starts.first(probes), 0, key);
    const auto is_suspect = [&](const Hit& hit) {
        if (hit.missed() || !hit.back_face) return false;
        return (geometry_.triangles[hit.triangle].flags & kDoubleSided) != 0 || is_near_back(hit, points);
    };
    return std::ranges::none_of(hits_.first(probes), is_suspect) && rows_are_free(points, starts, kPartings[0].lift);
}

VisibleStarts::Components VisibleStarts::parted(const Points& points, std::span<const SurfaceStart> starts,
                                                float lift) const {
    Components components(starts.size());
    if (rows_are_free(points, starts, lift)) {
        for (std::size_t i = 1; i < starts.size(); ++i) components.join(static_cast<std::uint8_t>(i), 0);
        return components;
    }
    const PointGrid grid(points.valid, starts.size());
    std::size_t count = 0;
    grid.for_each_pair([&](std::uint8_t a, std::uint8_t b) {
        rays_[count++] = segment(lifted(starts[a], points, lift), lifted(starts[b], points, lift));
    });
    tracer_.closest(rays_.first(count), hits_.first(count));
    count = 0;
    grid.for_each_pair([&](std::uint8_t a, std::uint8_t b) {
        if (!parts(hits_[count++], points)) components.join(a, b);
    });
    return components;
}

VisibleStarts::Found VisibleStarts::find(const Points& points, std::span<const SurfaceStart> starts,
                                         std::uint32_t key) const {
    const std::size_t n = starts.size();
    LUMEL_CHECK(n <= kSamplesPerTexel, n);
    std::uint64_t backs = 0;
    const auto probe = [&](std::size_t first, std::size_t last) {
        look_around(starts.first(last), first, key);
        for (std::size_t i = first; i < last; ++i)
            if (is_near_back(hits_[i], points)) backs |= std::uint64_t{1} << i;
    };
    probe(0, std::min(n, kFewProbes));
    const bool probed_all = n <= kFewProbes || backs != 0;
    if (probed_all && n > kFewProbes) probe(kFewProbes, n);
    const std::uint64_t probed = first_bits(probed_all ? n : kFewProbes);
    if ((first_bits(n) & ~(backs | points.enclosed)) == 0) return {};

    for (const Parting& parting : kPartings) {
        const Components components = parted(points, starts, parting.lift);
        std::array<std::uint64_t, kSamplesPerTexel> members{};
        for (std::size_t i = 0; i < n; ++i)
            members[components.root(static_cast<std::uint8_t>(i))] |= std::uint64_t{1} << i;
        // Of several, a point whose own ray met a back is the likeliest to be on the wrong side.
        const bool is_cut = std::ranges::find(members, first_bits(n)) == members.end();
        const std::uint64_t hidden = points.enclosed | (is_cut ? backs : 0);
        Found found;
        float most = 0.0f;
        for (const std::uint64_t m : members) {
            const int asked = std::popcount(m & probed);
            const float share =
                asked == 0 ? 0.0f : static_cast<float>(std::popcount(m & backs)) / static_cast<float>(asked);
            const float weight = static_cast<float>(std::popcount(m & ~points.enclosed)) *
                                 std::max(0.0f, 1.0f - share / parting.most_backs);
            const std::uint64_t open = m & ~hidden;
            if (weight > 0.0f) found.open |= open;
            if (weight <= most) continue;
            most = weight;
            found.best = open;
        }
        if (found.best != 0) return found;
    }
    return {};
}

bool VisibleStarts::is_shut(std::span<const SurfaceStart> starts, std::uint32_t key) const {
    look_around(starts, 0, key);
    const auto backs =
        std::ranges::count_if(hits_.first(starts.size()), [&](const Hit& hit) { return is_single_sided_back(hit); });
    return 2 * static_cast<std::size_t>(backs) > starts.size();
}

std::optional<FootprintPart> part_to_refine(const FootprintPart& part, std::uint64_t valid,
                                            const VisibleStarts::Found& found) {
    if (std::popcount(found.best) >= kFewPoints) return std::nullopt;
    std::uint32_t low_x = kGridEdge, low_y = kGridEdge, high_x = 0, high_y = 0;
    for (std::uint64_t open = found.open; open != 0; open >>= 1, valid &= valid - 1) {
        if ((open & 1u) == 0) continue;
        const std::uint32_t cell = cell_of(static_cast<std::uint32_t>(std::countr_zero(valid)));
        low_x = std::min(low_x, cell % kGridEdge);
        high_x = std::max(high_x, cell % kGridEdge);
        low_y = std::min(low_y, cell / kGridEdge);
        high_y = std::max(high_y, cell / kGridEdge);
    }
    // What is seen may reach into the cells beside those whose points are.
    const auto edges = [](std::uint32_t low, std::uint32_t high) {
        return Vec2{static_cast<float>(std::max(low, 1u) - 1), static_cast<float>(std::min(high + 2, kGridEdge))} *
               (1.0f / kGridEdge);
    };
    const Vec2 x = edges(low_x, high_x), y = edges(low_y, high_y), size = part.high - part.low;
    if (x.y - x.x + y.y - y.x >= 2.0f) return std::nullopt;
    return FootprintPart{part.low + Vec2{x.x, y.x} * size, part.low + Vec2{x.y, y.y} * size};
}

}  // namespace lumel
