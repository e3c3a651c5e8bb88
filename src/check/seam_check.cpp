#include "check/seam_check.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "check/lookup.h"

namespace lumel {
namespace {

struct Border {
    std::uint32_t triangle, corner;
};

// Edges that no second triangle has at the same place of the same page.
// Cut short where cancelled.
std::vector<Border> borders_of(const CheckedBake& bake, const Context& context) {
    struct Edge {
        std::uint32_t page, triangle, corner;
        Vec2 low, high;
        [[nodiscard]] auto key() const { return std::tuple(page, low.x, low.y, high.x, high.y); }
    };
    std::vector<Edge> edges;
    edges.reserve(3 * bake.triangles.size());
    for (std::uint32_t t = 0; t < bake.triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CheckedTriangle& triangle = bake.triangles[t];
            Vec2 a = triangle.uv[k], b = triangle.uv[(k + 1) % 3];
            if (std::tuple(b.x, b.y) < std::tuple(a.x, a.y)) std::swap(a, b);
            edges.push_back({triangle.page, t, k, a, b});
        }
    if (context.cancelled()) return {};
    std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
        return std::tuple(a.key(), a.triangle, a.corner) < std::tuple(b.key(), b.triangle, b.corner);
    });
    std::vector<Border> out;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end].key() == edges[i].key()) ++end;
        if (end == i + 1) out.push_back({edges[i].triangle, edges[i].corner});
    }
    return out;
}

// Borders by the cells of a grid that they pass through, and those within a distance of them. Cut short where
// cancelled.
class BorderGrid {
public:
    BorderGrid(const CheckedBake& bake, const std::vector<Border>& borders, double distance, const Context& context)
        : bake_(bake), borders_(borders), distance_(distance) {
        double sum = 0.0;
        for (const Border& border : borders) sum += static_cast<double>(length(to(border) - from(border)));
        cell_ = std::max(8.0 * distance, sum / static_cast<double>(std::max<std::size_t>(1, borders.size())));
        for (std::uint32_t b = 0; b < borders.size() && !context.cancelled(); ++b) insert(b);
        if (context.cancelled()) return;
        std::ranges::sort(entries_);
        entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
    }

    [[nodiscard]] Vec3 from(const Border& b) const { return bake_.triangles[b.triangle].position[b.corner]; }
    [[nodiscard]] Vec3 to(const Border& b) const { return bake_.triangles[b.triangle].position[(b.corner + 1) % 3]; }

    template <class Visit>
    void for_each_in_cell(Vec3 p, Visit&& visit) const {
        const Cell cell = cell_of(p, 0.0);
        for (auto it = std::ranges::lower_bound(entries_, std::pair(cell, 0u));
             it != entries_.end() && it->first == cell; ++it)
            visit(it->second);
    }

private:
    using Cell = std::array<std::int64_t, 3>;

    [[nodiscard]] Cell cell_of(Vec3 p, double shift) const {
        Cell cell;
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<std::int64_t>(std::floor((double{p[k]} + shift) / cell_));
        return cell;
    }
    // Steps of half a cell, each with all cells within what lies between two steps and the distance.
    void insert(std::uint32_t b) {
        const Vec3 start = from(borders_[b]), way = to(borders_[b]) - start;
        const auto steps = static_cast<std::uint32_t>(2.0 * static_cast<double>(length(way)) / cell_) + 1;
        const double reach = 0.25 * cell_ + distance_;
        for (std::uint32_t s = 0; s <= steps; ++s) {
            const Vec3 p = start + way * (static_cast<float>(s) / static_cast<float>(steps));
            const Cell low = cell_of(p, -reach), high = cell_of(p, reach);
            for (std::int64_t x = low[0]; x <= high[0]; ++x)
                for (std::int64_t y = low[1]; y <= high[1]; ++y)
                    for (std::int64_t z = low[2]; z <= high[2]; ++z) entries_.emplace_back(Cell{x, y, z}, b);
        }
    }

    const CheckedBake& bake_;
    const std::vector<Border>& borders_;
    double distance_, cell_ = 1.0;
    std::vector<std::pair<Cell, std::uint32_t>> entries_;
};

// A point of a border: where it is and what the runtime shows there.
struct Point {
    Vec3 position, normal, inward;  // inward: unit, off the border into its triangle
    Vec2 texels;
};

struct Sample {
    SeamDefect defect;
    double metres = 0.0;
    bool parted = false;
};

// What a chunk of borders finds. kReaches.size() rays for each sample.
struct Found {
    std::vector<Sample> samples;
    std::vector<Ray> rays;
};

// From beside one side of a seam to beside the other, `lift` above.
Ray ray_between(const Point& a, const Point& b, float beside, float lift) {
    const Vec3 up = normalize_or(a.normal + b.normal, a.normal) * lift;
    const Vec3 from = a.position + a.inward * beside + up, way = b.position + b.inward * beside + up - from;
    Ray ray;
    ray.origin = from;
    ray.direction = normalize_or(way, {0, 1, 0});
    ray.tmax = length(way);
    return ray;
}

// Half texels beside the seam: what stands on it within a lookup's reach parts it, however thick it is.
constexpr std::array<float, 3> kReaches{1.0f, 2.0f, 3.0f};

class SeamSearch {
public:
    // Of no use where cancelled.
    SeamSearch(const CheckedBake& bake, const SeamCheckOptions& options, const Context& context)
        : bake_(bake),
          options_(options),
          borders_(borders_of(bake, context)),
          distance_(distances()),
          grid_(bake, borders_, distance_.empty() ? 0.0 : std::ranges::max(distance_), context),
          mean_(mean_light(bake)) {}

    [[nodiscard]] std::size_t size() const { return borders_.size(); }

    void walk(std::size_t index, Found& out) const {
        const Border& border = borders_[index];
        const Point first = at(border, 0.0f), last = at(border, 1.0f);
        const double texels = static_cast<double>(length(last.texels - first.texels));
        const double metres = static_cast<double>(length(last.position - first.position));
        if (!(metres > 0.0)) return;
        // No border is longer than a page; a damaged file's may say so.
        const CheckedPage& page = bake_.pages[bake_.triangles[border.triangle].page];
        const double most = 4.0 * (static_cast<double>(page.width) + page.height);
        const auto n = static_cast<std::uint32_t>(std::clamp(std::ceil(texels * options_.points_per_texel), 1.0, most));
        for (std::uint32_t k = 0; k < n; ++k) {
            const Point point = at(border, (static_cast<float>(k) + 0.5f) / static_cast<float>(n));
            grid_.for_each_in_cell(point.position, [&](std::uint32_t other) {
                if (borders_[other].triangle == border.triangle) return;
                const double distance = std::min(distance_[index], distance_[other]);
                compare(border, point, borders_[other], distance, texels / metres, metres / n, out);
            });
        }
    }

private:
    [[nodiscard]] Point at(const Border& border, float t) const {
        const CheckedTriangle& triangle = bake_.triangles[border.triangle];
        const std::uint32_t k = border.corner, next = (k + 1) % 3;
        const Vec2 a = bake_.texels(triangle, k), b = bake_.texels(triangle, next);
        const Vec3 along = normalize_or(triangle.position[next] - triangle.position[k], {});
        const Vec3 across = triangle.position[(k + 2) % 3] - triangle.position[k];
        return {triangle.position[k] + (triangle.position[next] - triangle.position[k]) * t,
                normalize_or(triangle.normal[k] * (1.0f - t) + triangle.normal[next] * t, triangle.normal[k]),
                normalize_or(across - along * dot(across, along), {}), a + (b - a) * t};
    }

    [[nodiscard]] double length_of(const Border& border) const {
        return static_cast<double>(length(grid_.to(border) - grid_.from(border)));
    }

    [[nodiscard]] Point nearest(const Border& border, Vec3 p) const {
        const Vec3 from = grid_.from(border), way = grid_.to(border) - from;
        const float squared = dot(way, way);
        return at(border, squared > 0.0f ? std::clamp(dot(p - from, way) / squared, 0.0f, 1.0f) : 0.0f);
    }

    // Metres within which another border is the same line.
    [[nodiscard]] std::vector<double> distances() const {
        std::vector<double> out;
        out.reserve(borders_.size());
        for (const Border& border : borders_) {
            const Point from = at(border, 0.0f), to = at(border, 1.0f);
            const double texels = static_cast<double>(length(to.texels - from.texels));
            const double metres = static_cast<double>(length(to.position - from.position));
            out.push_back(std::min(options_.distance, options_.distance_in_texels * metres / std::max(texels, 1e-6)));
        }
        return out;
    }

    // `density`: texels per metre of the border that a lies on.
    void compare(const Border& border, const Point& a, const Border& other, double distance, double density,
                 double metres, Found& out) const {
        const Point b = nearest(other, a.position);
        if (static_cast<double>(length(a.position - b.position)) > distance) return;
        if (static_cast<double>(dot(a.normal, b.normal)) < options_.normal_cosine) return;
        if (dot(a.inward, b.inward) > 0.5f) return;  // layers: one lies on the other
        const CheckedTriangle &ta = bake_.triangles[border.triangle], &tb = bake_.triangles[other.triangle];
        // Around a corner of one border lies the same place of the layout.
        const double same = 0.02 + 2.0 * distance * density;
        if (ta.page == tb.page && static_cast<double>(length(a.texels - b.texels)) <= same) return;
        const double light_a = luminance_at(bake_.pages[ta.page], a.texels);
        const double light_b = luminance_at(bake_.pages[tb.page], b.texels);
        const double scale = 0.5 * (light_a + light_b) + 0.01 * mean_;
        const double contrast = scale > 0.0 ? std::fabs(light_a - light_b) / scale : 0.0;
        if (!std::isfinite(contrast)) return;  // another check's
        out.samples.push_back({{contrast, a.position, ta.instance, tb.instance, ta.page, a.texels}, metres});
        const auto half_texel = static_cast<float>(0.5 / std::max(density, 1.0 / length_of(border)));
        for (const float reach : kReaches) out.rays.push_back(ray_between(a, b, reach * half_texel, half_texel));
    }

    const CheckedBake& bake_;
    SeamCheckOptions options_;
    std::vector<Border> borders_;
    std::vector<double> distance_;  // per border
    BorderGrid grid_;
    double mean_;
};

// Samples by ascending contrast.
SeamContrast contrast_of(const std::vector<Sample>& sorted, bool parted, double visible) {
    SeamContrast out;
    for (const Sample& s : sorted) {
        if (s.parted != parted) continue;
        ++out.samples;
        out.metres += 0.5 * s.metres;
        if (s.defect.contrast > visible) out.visible_metres += 0.5 * s.metres;
        out.largest = s.defect.contrast;
    }
    double below = 0.0;
    for (const Sample& s : sorted) {
        if (s.parted != parted) continue;
        if (below < 0.5 * out.metres) out.median = s.defect.contrast;
        if (below < 0.99 * out.metres) out.p99 = s.defect.contrast;
        below += 0.5 * s.metres;
    }
    return out;
}

// The worst first, none within a hundredth of the scene of one that is told already.
std::vector<SeamDefect> worst_of(std::vector<Sample> samples, double visible) {
    constexpr std::size_t kMost = 100;
    Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const Sample& s : samples) low = min(low, s.defect.position), high = max(high, s.defect.position);
    const float apart = samples.empty() ? 0.0f : 0.01f * length(high - low);
    std::erase_if(samples, [visible](const Sample& s) { return s.parted || s.defect.contrast <= visible; });
    std::ranges::reverse(samples);
    std::vector<SeamDefect> out;
    for (const Sample& s : samples) {
        if (out.size() == kMost) break;
        const auto is_near = [&](const SeamDefect& d) { return length(d.position - s.defect.position) < apart; };
        if (std::ranges::none_of(out, is_near)) out.push_back(s.defect);
    }
    return out;
}

}  // namespace

Result<SeamCheck> check_seams(const CheckedBake& bake, const SeamCheckOptions& options, const Tracer& tracer,
                              Context& context) {
    constexpr std::size_t kBordersPerChunk = 1024;
    const SeamSearch search(bake, options, context);
    if (context.cancelled()) return cancelled_error();
    std::vector<std::vector<Sample>> parts((search.size() + kBordersPerChunk - 1) / kBordersPerChunk);
    const bool done = parallel_for(
        context, search.size(), kBordersPerChunk,
        [&](const ChunkRange& range) {
            Found found;
            for (std::size_t i = range.begin; i < range.end; ++i) search.walk(i, found);
            std::vector<std::uint8_t> blocked(found.rays.size());
            tracer.occluded(found.rays, blocked);
            for (std::size_t i = 0; i < blocked.size(); ++i)
                if (blocked[i] != 0) found.samples[i / kReaches.size()].parted = true;
            parts[range.index] = std::move(found.samples);
        },
        "seams");
    if (!done) return cancelled_error();
    std::vector<Sample> samples;
    for (const std::vector<Sample>& part : parts) samples.insert(samples.end(), part.begin(), part.end());
    if (context.cancelled()) return cancelled_error();
    std::ranges::stable_sort(samples, {}, [](const Sample& s) { return s.defect.contrast; });
    if (context.cancelled()) return cancelled_error();
    SeamCheck out;
    out.open = contrast_of(samples, false, options.visible);
    out.parted = contrast_of(samples, true, options.visible);
    out.worst = worst_of(std::move(samples), options.visible);
    return out;
}

}  // namespace lumel
