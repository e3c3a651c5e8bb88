#include "path/visible_starts.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/check.h"
#include "math/frame.h"
#include "math/sampler.h"
#include "math/warp.h"

namespace lumel {
namespace {

constexpr std::uint32_t kGridEdge = 8;     // one Hammersley point in each of 8 x 8 cells of the texel
constexpr std::size_t kFewProbes = 16;     // of the points, spread evenly, that are asked before the rest
constexpr float kLift = 0.05f;             // texels that short rays run above the surface: over its own bumps
constexpr float kMostVoid = 0.25f;         // share of void rays from where a place lies behind a surface
constexpr std::uint32_t kOpenRays = 16;    // by which that is judged where a texel would be moved to
constexpr std::uint32_t kMostAttempts = 3;  // nearest back faces that a texel is moved behind
constexpr float kSameDistance = 1e-3f;     // of a texel: what differs less is equally near

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
        for (std::uint8_t i = 0; i < n && valid != 0; ++i, valid &= valid - 1)
            point[cell_of(static_cast<std::uint32_t>(std::countr_zero(valid)))] = i;
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

class Components {
public:
    explicit Components(std::size_t n) {
        for (std::uint8_t i = 0; i < n; ++i) root_[i] = i;
    }
    void join(std::uint8_t a, std::uint8_t b) { root_[root(a)] = root(b); }
    [[nodiscard]] std::uint8_t root(std::uint8_t i) const {
        while (root_[i] != i) i = root_[i];
        return i;
    }

private:
    std::array<std::uint8_t, kSamplesPerTexel> root_{};
};

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

std::size_t nearest_to_centre(std::uint64_t valid) {
    std::size_t nearest = 0;
    float smallest = 1e30f;
    for (std::size_t i = 0; valid != 0; ++i, valid &= valid - 1) {
        const Vec2 d = subtexel_point(static_cast<std::uint32_t>(std::countr_zero(valid))) - Vec2{0.5f, 0.5f};
        if (dot(d, d) >= smallest) continue;
        smallest = dot(d, d);
        nearest = i;
    }
    return nearest;
}

VisibleStarts::VisibleStarts(const Tracer& tracer, const WorldGeometry& geometry, std::span<Ray> rays,
                             std::span<Hit> hits)
    : tracer_(tracer), geometry_(geometry), rays_(rays), hits_(hits) {
    LUMEL_CHECK(rays.size() >= 256 && hits.size() >= 256, rays.size(), hits.size());
}

// A ray from each start beyond the first few, over its hemisphere: bit i where that of start i is void.
std::uint64_t VisibleStarts::void_rays(std::span<const SurfaceStart> starts, std::size_t first,
                                       std::uint32_t key) const {
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
    std::uint64_t out = 0;
    for (std::size_t i = first; i < starts.size(); ++i) {
        const Hit& hit = hits_[i];
        if (!hit.missed() && hit.back_face && (geometry_.triangles[hit.triangle].flags & kDoubleSided) == 0)
            out |= std::uint64_t{1} << i;
    }
    return out;
}

// The texel's own triangles do not part its points: a chord of a curved surface runs below it.
bool VisibleStarts::blocked(const GatherSite& site, const Hit& hit) const {
    return !hit.missed() && !std::ranges::binary_search(site.triangles, hit.triangle);
}

VisibleStarts::Choice VisibleStarts::keep_visible(const GatherSite& site, std::span<SurfaceStart> starts,
                                                  std::uint64_t enclosed, std::uint32_t key) const {
    const std::size_t n = starts.size();
    LUMEL_CHECK(n <= kSamplesPerTexel, n);
    std::uint64_t voids = void_rays(starts.first(std::min(n, kFewProbes)), 0, key);
    const bool probed_all = n <= kFewProbes || voids != 0;
    if (voids != 0 && n > kFewProbes) voids |= void_rays(starts, kFewProbes, key);
    const std::uint64_t probed = first_bits(probed_all ? n : kFewProbes);

    const float lift = kLift * site.texel_size;
    const auto lifted = [&](std::uint8_t i) { return starts[i].origin + starts[i].normal * lift; };
    const PointGrid grid(site.valid, n);
    std::size_t count = 0;
    const auto queue = [&](std::uint8_t a, std::uint8_t b) { rays_[count++] = segment(lifted(a), lifted(b)); };
    grid.for_each_line(queue);
    tracer_.closest(rays_.first(count), hits_.first(count));
    const auto is_blocked = [&](const Hit& hit) { return blocked(site, hit); };
    Components components(n);
    if (std::ranges::any_of(hits_.first(count), is_blocked)) {
        count = 0;
        grid.for_each_pair(queue);
        tracer_.closest(rays_.first(count), hits_.first(count));
        count = 0;
        grid.for_each_pair([&](std::uint8_t a, std::uint8_t b) {
            if (!is_blocked(hits_[count++])) components.join(a, b);
        });
    } else {
        for (std::uint8_t i = 1; i < n; ++i) components.join(i, 0);
    }

    std::array<std::uint64_t, kSamplesPerTexel> members{};
    for (std::uint8_t i = 0; i < n; ++i) members[components.root(i)] |= std::uint64_t{1} << i;
    std::uint64_t best = 0;
    float most = 0.0f;
    for (const std::uint64_t m : members) {
        const int asked = std::popcount(m & probed);
        const float share = asked == 0 ? 0.0f : static_cast<float>(std::popcount(m & voids)) / static_cast<float>(asked);
        const float weight =
            static_cast<float>(std::popcount(m & ~enclosed)) * std::max(0.0f, 1.0f - share / kMostVoid);
        if (weight <= most) continue;
        most = weight;
        best = m & ~enclosed;
    }
    if (best == 0) return {StartFate::hidden, n};
    if (best == first_bits(n)) return {StartFate::all, n};
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i)
        if ((best >> i & 1u) != 0) starts[kept++] = starts[i];
    return {StartFate::some, kept};
}

bool VisibleStarts::is_open(const SurfaceStart& start, std::uint32_t key) const {
    std::array<SurfaceStart, kOpenRays> same;
    same.fill(start);
    return static_cast<float>(std::popcount(void_rays(same, 0, key))) <= kMostVoid * kOpenRays;
}

VisibleStarts::Choice VisibleStarts::push_out(const GatherSite& site, std::span<SurfaceStart> starts,
                                              std::uint32_t key) const {
    const Choice stays{StartFate::hidden, starts.size()};
    if (!site.axes.known()) return stays;
    const SurfaceStart start = starts[std::min(nearest_to_centre(site.valid), starts.size() - 1)];
    const Vec3 from = start.origin + start.normal * (kLift * site.texel_size);
    const Vec3 x = site.axes.x, y = site.axes.y;
    const std::array<Vec3, 8> steps{x, -x, y, -y, x + y, x - y, y - x, -x - y};
    for (std::size_t i = 0; i < steps.size(); ++i) rays_[i] = segment(from, from + steps[i]);
    tracer_.closest(rays_.first(steps.size()), hits_.first(steps.size()));

    struct Exit {
        Vec3 step, normal;
        float distance, reach;
    };
    std::array<Exit, steps.size()> exits;
    std::size_t count = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!blocked(site, hits_[i]) || !hits_[i].back_face) continue;
        exits[count++] = {rays_[i].direction, geometry_.geometric_normal(hits_[i].triangle), hits_[i].t, rays_[i].tmax};
    }
    // Equally near exits are taken in the order of the texel's own axes, however the scene is turned.
    const float same = kSameDistance * site.texel_size;
    std::stable_sort(exits.begin(), exits.begin() + static_cast<std::ptrdiff_t>(count), [&](const Exit& a, const Exit& b) {
        return std::floor(a.distance / same) < std::floor(b.distance / same);
    });
    for (std::size_t k = 0; k < std::min<std::size_t>(count, kMostAttempts); ++k) {
        const Exit& exit = exits[k];
        // Of what the texel's weight in lookups (a tent of one texel) leaves beyond the wall, the centre lies a third in.
        const Vec3 along = exit.normal - start.normal * dot(exit.normal, start.normal);
        const Vec3 out = normalize_or(along, exit.step);
        const float beyond = std::max(kLift * site.texel_size, (exit.reach - exit.distance) / 3.0f);
        SurfaceStart moved = start;
        const Vec3 wall = exit.step * exit.distance;
        for (const float share : {1.0f, 0.25f}) {
            const Vec3 move = wall + out * (share * beyond);
            Ray& ray = rays_[0] = segment(from + wall + out * (0.1f * share * beyond), from + move);
            tracer_.closest(std::span(&ray, 1), hits_.first(1));
            if (blocked(site, hits_[0])) continue;
            moved.origin = start.origin + move;
            moved.skip = kNone;
            if (!is_open(moved, key)) continue;
            starts[0] = moved;
            return {StartFate::moved, 1};
        }
    }
    return stays;
}

}  // namespace lumel
