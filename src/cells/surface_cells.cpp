#include "cells/surface_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/progress_parts.h"
#include "base/try.h"
#include "texel/ray_offset.h"

namespace lumel {
namespace {

constexpr float kLift = 1.0f / 16;  // of the points that look at each other, in edges of the cell
constexpr float kSettled =
    1e-5f;  // change of a cell by one more bounce, of its light; with albedo 0.8 four times as much is missing

constexpr const char* kStage = "cells";  // of the progress
// Shares of the time that it takes to lay out cells and to see who sees whom.
constexpr double kLayoutWork = 1.0, kMiddlesWork = 1.0, kSightWork = 3.0;

// The eight texels around one, in this order.
constexpr std::array<std::array<std::int32_t, 2>, 8> kNeighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
std::uint32_t neighbour_bit(std::int32_t dx, std::int32_t dy) {
    const std::int32_t index = (dy + 1) * 3 + (dx + 1);
    return static_cast<std::uint32_t>(index > 4 ? index - 1 : index);
}

constexpr std::uint32_t kBouncesOfNoise = 16;  // with albedo 0.8 the rest is 3 % of the deviation

// What comes over the links of `paths` paths of a cell, of these values of others.
Vec3 linked(std::span<const CellLink> links, std::span<const Vec3> values, std::uint32_t paths) {
    Vec3 sum{};
    for (const CellLink& link : links) {
        if (link.from == kNone) continue;
        const Vec3 from = values[link.from];
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<float>(link.weight[c]) * from[c];
    }
    return sum * (1.0f / (CellLink::kOne * static_cast<float>(std::max(1u, paths))));
}

// From one point to another; they must not coincide.
Ray segment(Vec3 from, Vec3 move, float distance) {
    Ray ray;
    ray.origin = from;
    ray.direction = move / distance;
    ray.tmax = distance;
    return ray;
}

}  // namespace

Result<SurfaceCells> SurfaceCells::make(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                        const Atlas& atlas, const Tracer& tracer, double texels_per_cell,
                                        Context& context) {
    LUMEL_CHECK(texels_per_cell > 0.0, texels_per_cell);
    SurfaceCells cells;
    ChartOptions layout;
    if (charts.scene_wide) {
        const auto shrink = [&](std::uint32_t edge) {
            return std::max(2u, static_cast<std::uint32_t>(std::ceil(edge / texels_per_cell)));
        };
        layout.resolution_width = shrink(atlas.pages[0].width);
        layout.resolution_height = shrink(atlas.pages[0].height);
    } else {
        layout.texels_per_metre = atlas.texels_per_metre / texels_per_cell;
    }
    // What the cells' layout has to say of charts is no news to the user.
    const Diagnostics before = context.diagnostics;
    LUMEL_TRY(cells.atlas_, make_atlas(scene, geometry, charts, layout, context));
    ProgressParts progress(context, kStage, kLayoutWork + kMiddlesWork + kSightWork);
    progress.begin(kLayoutWork);
    LUMEL_TRY_STATUS(cells.rasterize(scene, geometry, charts, context));
    context.diagnostics = before;
    cells.lay_out(scene, geometry, charts);
    progress.begin(kMiddlesWork);
    std::vector<Vec3> middles;
    if (!cells.find_middles(scene, geometry, charts, middles, context)) return cancelled_error();
    progress.begin(kSightWork);
    if (!cells.find_visibility(scene, geometry, charts, tracer, middles, context)) return cancelled_error();
    return cells;
}

Status SurfaceCells::rasterize(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                               Context& context) {
    const auto by_page = triangles_by_page(scene, geometry, charts, atlas_);
    ProgressParts progress(context, kStage, static_cast<double>(atlas_.pages.size()));
    for (std::uint32_t page = 0; page < atlas_.pages.size(); ++page) {
        progress.begin(1.0);
        LUMEL_TRY(TexelBuffer texels, rasterize_page(scene, geometry, charts, atlas_, page, by_page[page], context));
        pages_.push_back(std::move(texels));
    }
    return success();
}

void SurfaceCells::lay_out(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts) {
    std::size_t count = 0;
    for (const TexelBuffer& texels : pages_) count += texels.size();
    sites_.reserve(count);
    for (std::uint32_t page = 0; page < pages_.size(); ++page) {
        const TexelBuffer& texels = pages_[page];
        first_cell_.push_back(static_cast<std::uint32_t>(sites_.size()));
        for (std::uint32_t i = 0; i < texels.size(); ++i) sites_.push_back({page, i, texels.world_size[i], kNone});
    }
    std::uint32_t next = static_cast<std::uint32_t>(sites_.size());
    for (std::uint32_t front = 0; front < sites_.size(); ++front) {
        Site& s = sites_[front];
        const TexelBuffer& texels = pages_[s.page];
        const std::uint32_t triangle = texels.triangles[texels.first_triangle[s.texel]];
        if (!(geometry.triangles[triangle].flags & kDoubleSided)) continue;
        s.back = next++;
        front_of_.push_back(front);
    }
    usable_.assign(next, 1);
    open_.assign(next, 0);
    irradiance_.assign(next, Vec3{});
    triangles_.resize(geometry.triangle_count());
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
        const Atlas::TriangleUv uv = atlas_.triangle_uv(charts, geometry, scene, t);
        if (uv.page == kNone) continue;
        const WorldTriangle& triangle = geometry.triangles[t];
        const MeshCharts& mesh = charts.meshes[scene.instances[triangle.instance].mesh];
        triangles_[t] = {uv.texels, uv.page,
                         atlas_.first_placement[triangle.instance] + mesh.chart_of_triangle[triangle.mesh_triangle]};
    }
}

std::uint32_t SurfaceCells::front_at(std::uint32_t page, std::int32_t x, std::int32_t y,
                                     std::uint32_t placement) const {
    const std::uint32_t texel = pages_[page].at(x, y);
    if (texel == kNone || pages_[page].chart[texel] != placement) return kNone;
    return first_cell_[page] + texel;
}

SurfaceCells::Place SurfaceCells::find(std::uint32_t triangle, float b1, float b2, bool back_face) const {
    const Corners& c = triangles_[triangle];
    if (c.page == kNone) return {};
    const Vec2 p = c.uv[0] * (1.0f - b1 - b2) + c.uv[1] * b1 + c.uv[2] * b2;
    Place place{kNone, c.page,   c.placement, static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
                {},    back_face};
    place.offset = {p.x - static_cast<float>(place.x) - 0.5f, p.y - static_cast<float>(place.y) - 0.5f};
    const std::uint32_t front = front_at(c.page, place.x, place.y, c.placement);
    const std::uint32_t cell = back_face && front != kNone ? sites_[front].back : front;
    if (cell != kNone && usable_[cell]) place.home = cell;
    return place;
}

std::uint32_t SurfaceCells::seen_from(const Place& place, std::int32_t dx, std::int32_t dy) const {
    if ((dx == 0 && dy == 0) || !(open_[place.home] >> neighbour_bit(dx, dy) & 1u)) return place.home;
    const std::uint32_t front = front_at(place.page, place.x + dx, place.y + dy, place.placement);
    const std::uint32_t cell = place.back && front != kNone ? sites_[front].back : front;
    return cell != kNone && usable_[cell] ? cell : place.home;
}

Vec3 SurfaceCells::irradiance(const Place& place) const { return interpolate(irradiance_, place); }

Vec3 SurfaceCells::noise(const Place& place) const { return interpolate(noise_, place); }

Vec3 SurfaceCells::interpolate(std::span<const Vec3> values, const Place& place) const {
    const std::int32_t dx = place.offset.x < 0.0f ? -1 : 1, dy = place.offset.y < 0.0f ? -1 : 1;
    const float u = std::fabs(place.offset.x), v = std::fabs(place.offset.y);
    return values[place.home] * ((1.0f - u) * (1.0f - v)) + values[seen_from(place, dx, 0)] * (u * (1.0f - v)) +
           values[seen_from(place, 0, dy)] * ((1.0f - u) * v) + values[seen_from(place, dx, dy)] * (u * v);
}

std::uint32_t SurfaceCells::pick(const Place& place, Vec2 jitter) const {
    return seen_from(place, static_cast<std::int32_t>(std::floor(place.offset.x + jitter.x)),
                     static_cast<std::int32_t>(std::floor(place.offset.y + jitter.y)));
}

std::uint32_t SurfaceCells::sample_points(std::uint32_t cell, const Scene& scene, const WorldGeometry& geometry,
                                          const ChartSet& charts, std::span<SamplePoint, kSamplesPerTexel> out) const {
    if (!usable_[cell]) return 0;
    const Site& s = site(cell);
    return lumel::sample_points(pages_[s.page], s.texel, scene, geometry, charts, atlas_, out, Footprint::whole);
}

namespace {

Vec3 lifted(const WorldGeometry& geometry, const SamplePoint& point, float lift) {
    const auto [t, b1, b2] = point;
    return geometry.position(t, b1, b2) + geometry.shading_normal(t, b1, b2) * lift;
}

// From the surface up to the lifted point.
Ray rise(const WorldGeometry& geometry, const SamplePoint& point, bool back, Vec3 to) {
    const auto [t, b1, b2] = point;
    const Vec3 from = offset_origin(geometry, t, b1, b2, geometry.geometric_normal(t) * (back ? -1.0f : 1.0f));
    Ray ray = segment(from, to - from, std::max(length(to - from), std::numeric_limits<float>::min()));
    ray.skip = t;
    return ray;
}

// The point nearest to the middle of all: a texel's own centre may lie on the rim of its chart, at the foot of a wall.
const SamplePoint& middle_of(std::span<const SamplePoint> points, const WorldGeometry& geometry) {
    const auto position = [&](const SamplePoint& p) { return geometry.position(p.triangle, p.b1, p.b2); };
    Vec3 mean{};
    for (const SamplePoint& p : points) mean += position(p) * (1.0f / static_cast<float>(points.size()));
    const auto off = [&](const SamplePoint& p) {
        const Vec3 d = position(p) - mean;
        return dot(d, d);
    };
    const SamplePoint* best = &points[0];
    for (const SamplePoint& p : points)
        if (off(p) < off(*best)) best = &p;
    return *best;
}

}  // namespace

float SurfaceCells::lift_of(std::uint32_t cell) const { return (is_back(cell) ? -kLift : kLift) * site(cell).edge; }

bool SurfaceCells::find_middles(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                std::vector<Vec3>& middles, Context& context) const {
    middles.resize(size());
    const auto find = [&](const ChunkRange& range) {
        std::array<SamplePoint, kSamplesPerTexel> points;
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const auto cell = static_cast<std::uint32_t>(i);
            const std::uint32_t n = sample_points(cell, scene, geometry, charts, points);
            middles[i] = lifted(geometry, middle_of(std::span(points).first(n), geometry), lift_of(cell));
        }
    };
    return parallel_for(context, size(), 64, find, kStage);
}

// A cell whose sample points are not all seen from its middle is not usable; neighbours lend each other light where
// their middles see each other. Points are lifted a little, so that roughness of the surface itself does not count, and
// must see the surface below: nothing lies on a cell.
bool SurfaceCells::find_visibility(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                   const Tracer& tracer, std::span<const Vec3> middles, Context& context) {
    const auto look = [&](const ChunkRange& range) {
        std::array<SamplePoint, kSamplesPerTexel> points;
        std::array<Ray, 2 * kSamplesPerTexel + kNeighbours.size()> rays;
        std::array<std::uint8_t, rays.size()> blocked;
        std::array<std::uint32_t, kNeighbours.size()> bits{};
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const auto cell = static_cast<std::uint32_t>(i);
            const Site& s = site(cell);
            const TexelBuffer& texels = pages_[s.page];
            std::size_t count = 0;
            const auto look_at = [&](Vec3 to) {
                const float distance = length(to - middles[i]);
                if (!(distance > 0.0f)) return false;
                rays[count++] = segment(middles[i], to - middles[i], distance);
                return true;
            };
            const std::uint32_t n = sample_points(cell, scene, geometry, charts, points);
            for (std::uint32_t k = 0; k < n; ++k) {
                const Vec3 to = lifted(geometry, points[k], lift_of(cell));
                look_at(to);
                rays[count++] = rise(geometry, points[k], is_back(cell), to);
            }
            const std::size_t own = count;
            for (const auto& [dx, dy] : kNeighbours) {
                const std::uint32_t front =
                    front_at(s.page, texels.x[s.texel] + dx, texels.y[s.texel] + dy, texels.chart[s.texel]);
                const std::uint32_t other = is_back(cell) && front != kNone ? sites_[front].back : front;
                if (other != kNone && look_at(middles[other])) bits[count - own - 1] = neighbour_bit(dx, dy);
            }
            tracer.occluded(std::span(rays).first(count), std::span(blocked).first(count));
            const auto outside = blocked.begin() + static_cast<std::ptrdiff_t>(own);
            usable_[cell] = std::find(blocked.begin(), outside, 1) == outside ? 1 : 0;
            for (std::size_t k = own; k < count; ++k)
                if (!blocked[k]) open_[cell] |= static_cast<std::uint8_t>(1u << bits[k - own]);
        }
    };
    const std::uint64_t rays_before = tracer.statistics().rays;
    return parallel_for(context, size(), 64, look, kStage, [&] { return tracer.statistics().rays - rays_before; });
}

void SurfaceCells::drop_sites() {
    for (TexelBuffer& page : pages_) {
        TexelBuffer kept;
        kept.width = page.width;
        kept.height = page.height;
        kept.chart = std::move(page.chart);
        kept.texel_at = std::move(page.texel_at);
        page = std::move(kept);
    }
}

Status SurfaceCells::solve(std::span<const CellGather> gathers, std::span<const CellLink> links, std::uint32_t bounces,
                           Context& context) {
    LUMEL_CHECK(gathers.size() == size(), gathers.size(), size());
    LUMEL_CHECK(links.size() % std::max<std::size_t>(1, size()) == 0, links.size(), size());
    const std::size_t links_each = size() == 0 ? 0 : links.size() / size();
    // Cells that are not usable keep their light: links of others end there.
    std::vector<Vec3> direct(size());
    for (std::size_t i = 0; i < size(); ++i) {
        const bool sound = gathers[i].traced > 0 && is_finite(gathers[i].direct);
        if (!sound || 2 * gathers[i].open < gathers[i].traced) usable_[i] = 0;
        if (sound) direct[i] = gathers[i].direct;
    }
    irradiance_ = direct;
    std::uint32_t carried = 1;  // bounces
    std::vector<Vec3> next(size());
    std::vector<std::uint8_t> settled(size());
    for (; carried < bounces; ++carried) {
        const bool done = parallel_for(context, size(), 256, [&](const ChunkRange& range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                next[i] = direct[i] + linked(links.subspan(i * links_each, links_each), irradiance_, gathers[i].traced);
                // Cell by cell: a dim room beside a bright yard has its own pace.
                settled[i] = max_component(next[i] - irradiance_[i]) <= kSettled * max_component(next[i]) ? 1 : 0;
            }
        });
        if (!done) return cancelled_error();
        std::swap(irradiance_, next);
        if (std::find(settled.begin(), settled.end(), 0) == settled.end()) break;
        context.report(kStage, static_cast<double>(carried) / bounces);
    }
    if (!find_noise(gathers, links, carried, context)) return cancelled_error();
    context.report(kStage, 1.0);
    return success();
}

// A group's paths alone would have given I + e, where e = r + T e: r is what their first bounce changes and T are their
// links. What gathers from cells takes e by all links. The variance of the mean of all groups is that of the groups'
// own over their number.
bool SurfaceCells::find_noise(std::span<const CellGather> gathers, std::span<const CellLink> links,
                              std::uint32_t bounces, Context& context) {
    const std::size_t links_each = size() == 0 ? 0 : links.size() / size();
    noise_.assign(size(), {});
    relative_noise_ = {};
    if (links_each < kCellGroups) return true;
    std::vector<Vec3> first(size()), error(size()), next(size()), sum(size());
    const auto each_cell = [&](const auto& visit) {
        return parallel_for(context, size(), 256, [&](const ChunkRange& range) {
            for (std::size_t i = range.begin; i < range.end; ++i) visit(i);
        });
    };
    const auto all_links = [&](std::size_t i, std::span<const Vec3> values) {
        return linked(links.subspan(i * links_each, links_each), values, gathers[i].traced);
    };
    for (std::size_t g = 0; g < kCellGroups; ++g) {
        const std::size_t begin = (g * links_each + kCellGroups - 1) / kCellGroups;
        const std::size_t end = ((g + 1) * links_each + kCellGroups - 1) / kCellGroups;
        const auto of_group = [&](std::size_t i, std::span<const Vec3> values) {
            return linked(links.subspan(i * links_each + begin, end - begin), values,
                          static_cast<std::uint32_t>(end - begin));
        };
        const bool started = each_cell([&](std::size_t i) {
            const bool sound = gathers[i].traced > 0 && is_finite(gathers[i].direct);
            first[i] = sound ? gathers[i].direct_of_group[g] + of_group(i, irradiance_) - irradiance_[i] : Vec3{};
        });
        if (!started) return false;
        error = first;
        for (std::uint32_t bounce = 1; bounce < std::min(bounces, kBouncesOfNoise); ++bounce) {
            if (!each_cell([&](std::size_t i) { next[i] = first[i] + of_group(i, error); })) return false;
            std::swap(error, next);
        }
        const bool gathered = each_cell([&](std::size_t i) {
            const Vec3 brought = all_links(i, error);
            sum[i] += brought;
            noise_[i] += brought * brought;
        });
        if (!gathered) return false;
    }
    std::array<double, 3> noise{}, light{};
    for (std::size_t i = 0; i < size(); ++i) {
        constexpr float kGroups{kCellGroups};
        noise_[i] = max(noise_[i] - sum[i] * sum[i] * (1.0f / kGroups), Vec3{}) * (1.0f / (kGroups * (kGroups - 1.0f)));
        if (!is_finite(noise_[i])) noise_[i] = {};
        if (!usable_[i]) continue;
        const Vec3 brought = all_links(i, irradiance_);
        for (std::size_t c = 0; c < 3; ++c) {
            noise[c] += double{noise_[i][c]};
            light[c] += double{brought[c]} * double{brought[c]};
        }
    }
    for (std::size_t c = 0; c < 3; ++c)
        relative_noise_[c] = light[c] > 0.0 ? static_cast<float>(noise[c] / light[c]) : 0.0f;
    for (std::size_t i = 0; i < size(); ++i) {
        const Vec3 brought = all_links(i, irradiance_);
        noise_[i] = max(noise_[i], relative_noise_ * brought * brought);
    }
    return true;
}

}  // namespace lumel
