// Paths from the cells of the radiance cache: the light that reaches a cell by itself, and its links.
#include <algorithm>
#include <array>
#include <bit>

#include "base/check.h"
#include "math/sampler.h"
#include "path/enclosed_points.h"
#include "path/path_integrator.h"
#include "path/path_workspace.h"
#include "path/trace_paths.h"

namespace lumel {
namespace {

// What reaches a cell by itself, and its links.
class CellSink {
public:
    static constexpr bool kFromCell = true, kSunsKnown = true, kMayBeGuided = false;

    CellSink(std::span<CellLink> links, CellGather& gather) : links_(links), gather_(gather) {}

    void begin(std::span<const PathStart> starts, std::uint32_t first) {
        starts_ = starts;
        first_ = first;
        gather_.traced += static_cast<std::uint32_t>(starts.size());
        gather_.open += static_cast<std::uint32_t>(starts.size());
    }
    void back(std::uint32_t, float) { --gather_.open; }
    void free_path(std::uint32_t, Vec3, float, float, bool) {}
    void light(std::uint32_t lane, Layer, Vec3 direction, Vec3 value) {
        const Vec3 brought = value * (std::max(0.0f, dot(direction, starts_[lane].normal)) * kInvPi);
        sum_ += brought;
        gather_.direct_of_group[cell_group(first_ + lane, links_.size())] += brought;
    }
    void link(std::uint32_t lane, Vec3 direction, float pdf, std::uint32_t cell, Vec3 share) {
        const float cosine = std::max(0.0f, dot(direction, starts_[lane].normal));
        CellLink& link = links_[first_ + lane];
        link.from = cell;
        for (std::size_t c = 0; c < 3; ++c)
            link.weight[c] = static_cast<std::uint16_t>(
                std::min(65535.0f, share[c] * (cosine * kInvPi / pdf * CellLink::kOne) + 0.5f));
    }
    void end() {
        if (gather_.traced > 0) gather_.direct = sum_ * (1.0f / static_cast<float>(gather_.traced));
        std::array<std::uint32_t, kCellGroups> paths{};
        for (std::size_t k = 0; k < links_.size(); ++k) ++paths[cell_group(k, links_.size())];
        for (std::size_t g = 0; g < kCellGroups; ++g)
            gather_.direct_of_group[g] =
                gather_.direct_of_group[g] * (1.0f / static_cast<float>(std::max(1u, paths[g])));
    }

private:
    std::span<CellLink> links_;
    CellGather& gather_;
    std::span<const PathStart> starts_;
    std::uint32_t first_ = 0;
    Vec3 sum_{};
};

}  // namespace

void PathIntegrator::gather_cell(const GatherSite& site, bool back, Workspace& w, CellGather& out,
                                 std::span<CellLink> links) const {
    LUMEL_CHECK(!site.points.empty() && site.points.size() <= kSamplesPerTexel, site.points.size());
    const std::uint32_t key = sampler_key(options_.seed, site.id);
    std::size_t n = site.points.size();
    std::fill(w.sides.begin(), w.sides.end(), static_cast<std::uint8_t>(back));
    surface_starts(site.points, std::span(w.sides).first(n), w, w.surfaces);
    if (any_double_sided_) {
        // A texel that is shut in is gathered all the same, for it has to have some light; nobody sees such a cell.
        const auto starts = std::span(w.surfaces).first(n);
        const std::uint64_t enclosed = enclosed_points(starts, kEnclosureReach * site.texel_size, mix32(key),
                                                       transport_.tracer, transport_.geometry, w.rays, w.hits);
        if (static_cast<std::size_t>(std::popcount(enclosed)) == n) return;
        n = keep_open_points(starts, enclosed);
    }
    find_sunlit(std::span(w.surfaces).first(n), true, w);
    CellSink sink(links, out);
    for (std::uint32_t base = 0; base < links.size(); base += kWavefrontLanes) {
        const auto lanes = std::min<std::uint32_t>(kWavefrontLanes, static_cast<std::uint32_t>(links.size()) - base);
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            const SurfaceStart& start = w.surfaces[point_of(base + lane, key, n)];
            w.starts[lane] = {start.origin, start.normal, key, base + lane, start.skip, start.sunlit};
        }
        const auto starts = std::span<const PathStart>(w.starts).first(lanes);
        sink.begin(starts, base);
        trace_paths(starts, w, sink, {});
    }
    sink.end();
}

}  // namespace lumel
