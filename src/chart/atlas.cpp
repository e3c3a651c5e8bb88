// make_atlas: how large each chart is drawn and where it lies.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <span>
#include <string>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/try.h"
#include "chart/atlas_record.h"
#include "chart/chart_set.h"
#include "chart/density.h"
#include "chart/kept_layout.h"
#include "chart/pack.h"
#include "chart/pack_around.h"
#include "chart/page_clusters.h"

namespace lumel {
namespace {

// Placement ranges: as many as the instance's mesh has charts, none for instances without texels.
std::vector<std::uint32_t> placement_ranges(const Scene& scene, const ChartSet& charts) {
    std::vector<std::uint32_t> first{0};
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::size_t count = charts.meshes[scene.instances[i].mesh].charts.size();
        first.push_back(first.back() + (charts.gets_texels(scene, i) ? static_cast<std::uint32_t>(count) : 0));
    }
    return first;
}

Atlas kept_atlas(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                 const ChartOptions& options) {
    Atlas atlas;
    atlas.first_placement = placement_ranges(scene, charts);
    const AtlasPage page = kept_page(scene, geometry, charts, options);
    atlas.pages.push_back(page);
    const ChartPlacement placement{0, {static_cast<float>(page.width), static_cast<float>(page.height)}, {}};
    atlas.placements.assign(atlas.first_placement.back(), placement);
    if (options.previous) {
        const std::vector<std::uint32_t> found = find_in_record(*options.previous, chart_names(scene, charts));
        atlas.kept = found.size() - static_cast<std::uint64_t>(std::ranges::count(found, kNone));
    }
    return atlas;
}

// What the texels of charts are made by must be possible, and pages whole cells.
Status check_masks(const ChartOptions& options) {
    const MaskRule& rule = options.masks;
    const auto bad = [](std::string message, std::string remedy) {
        return Error{ErrorCode::usage, std::move(message), {}, std::move(remedy)};
    };
    if (rule.mips > MaskRule::kMaxMips)
        return bad("charts cannot be kept apart in mip " + std::to_string(rule.mips),
                   "ask for " + std::to_string(MaskRule::kMaxMips) + " at most");
    if (rule.block != 1 && rule.block != 4)
        return bad("blocks of " + std::to_string(rule.block) + " texels are not known", "ask for 1 or 4");
    if (options.resolution_width % rule.cell() == 0 && options.resolution_height % rule.cell() == 0) return success();
    return bad("a page of " + std::to_string(options.resolution_width) + "x" +
                   std::to_string(options.resolution_height) + " texels is no whole number of cells of " +
                   std::to_string(rule.cell()),
               "ask for a --resolution of multiples of " + std::to_string(rule.cell()));
}

Status check_page_choice(const ChartOptions& options) {
    if (options.pages == 0 && !options.page_clusters) return success();
    if (options.resolution_width != 0)
        return Error{
            ErrorCode::usage, "--pages does not go with --resolution, which is of one page", {}, "leave one out"};
    if (options.previous)
        return Error{ErrorCode::usage, "--pages does not go with --atlas, whose pages stay", {}, "leave one out"};
    return success();
}

Status check_byte_budget(const ChartOptions& options, bool scene_wide) {
    if (options.atlas_bytes == 0) return success();
    if (!(options.bytes_per_texel > 0.0))
        return Error{ErrorCode::usage, "--bytes-per-texel is not above 0", {}, "1 is what BC6H and BC7 take"};
    const auto bad = [](const char* what, const char* remedy) {
        return Error{ErrorCode::usage, std::string("--atlas-bytes does not go with ") + what, {}, remedy};
    };
    if (scene_wide)
        return bad("a TEXCOORD_1 that is kept as one atlas of the scene",
                   "take --uv1 mesh or ignore, or --resolution instead of --atlas-bytes");
    if (options.texels_per_metre > 0.0) return bad("--texels-per-metre: it solves the density", "leave one out");
    if (options.resolution_width != 0) return bad("--resolution, which is of one page", "leave one out");
    if (options.previous) return bad("--atlas, whose density stays", "leave one out");
    return success();
}

// The middle of the box around each instance.
std::vector<Vec3> instance_centres(const Scene& scene, const WorldGeometry& geometry) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        constexpr float kFar = std::numeric_limits<float>::max();
        Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
        for (std::uint32_t t = geometry.first_triangle[i]; t < geometry.first_triangle[i + 1]; ++t)
            for (const Vec3& p : geometry.corners(t)) {
                low = min(low, p);
                high = max(high, p);
            }
        out.push_back(0.5f * low + 0.5f * high);
    }
    return out;
}

class AtlasMaker {
public:
    AtlasMaker(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts, const ChartOptions& options,
               Context& context)
        : scene_(scene),
          geometry_(geometry),
          charts_(charts),
          options_(options),
          context_(context),
          instances_(chart_instances(scene, charts)) {}

    Result<Atlas> run() {
        Atlas atlas;
        atlas.first_placement = placement_ranges(scene_, charts_);
        LUMEL_CHECK(atlas.first_placement.back() == instances_.size());
        if (instances_.empty()) return atlas;
        const bool fixed = options_.resolution_width != 0;
        LUMEL_TRY_STATUS(options_.previous ? keep_previous(*options_.previous)
                         : fixed           ? fit_resolution()
                                           : fill_pages());
        atlas.masks = options_.masks;
        atlas.kept = kept_;
        atlas.texels_per_metre = sized_.reached;
        atlas.least_texels_per_metre = sized_.least;
        atlas.density = density_;
        for (const PackPage& page : packing_.pages) atlas.pages.push_back({page.width * cell(), page.height * cell()});
        if (fixed) atlas.pages.front() = {options_.resolution_width, options_.resolution_height};
        for (std::size_t k = 0; k < instances_.size(); ++k) atlas.placements.push_back(placement(k));
        return atlas;
    }

private:
    // Pages as needed, at the density asked or solved for.
    Status fill_pages() {
        const SizeLimit limit = SizeLimit::of_page(options_.max_page, options_.max_page, options_.masks);
        if (limit.width < 2) return no_room();
        if (options_.atlas_bytes > 0) return fill_bytes(limit);
        density_ = options_.texels_per_metre;
        if (!(density_ > 0.0)) {
            // A budget that the smallest charts eat by more than half is too small to be meant.
            const double budget =
                std::max(options_.texel_budget, 2.0 * least_texels(instances_, BudgetOf::baked, options_.masks));
            LUMEL_TRY(density_, solve_density(charts_, instances_, budget, BudgetOf::baked, limit, context_));
        }
        LUMEL_TRY(const bool fits, try_pages(limit));
        if (!fits) return no_room();
        report_clamped();
        return success();
    }

    // At density_.
    Result<bool> try_pages(SizeLimit limit) {
        LUMEL_TRY_STATUS(draw(limit, options_.sizes));
        const std::uint32_t max_page = options_.max_page / cell();
        const bool clusters = options_.page_clusters || options_.pages != 0;
        packing_ = clusters ? pack_clusters(sized_.masks, items(), places(), max_page, options_.pages, context_)
                            : pack(sized_.masks, items(), max_page, context_);
        if (context_.cancelled()) return cancelled_error();
        return packing_.complete;
    }

    // The highest density found whose pages, as they are packed, take no more than atlas_bytes.
    Status fill_bytes(SizeLimit limit) {
        const double unit = texels_at_unit_density(charts_, instances_);
        const double budget = static_cast<double>(options_.atlas_bytes);
        const double per_texel = options_.bytes_per_texel * mip_sum(options_.masks);
        const double even = unit > 0.0 ? std::sqrt(budget / (per_texel * unit)) : 1.0;  // without any border or gap
        // As small as can be.
        density_ = 1e-6 * even;
        LUMEL_TRY(const bool any, try_pages(limit));
        if (!any) return no_room();
        if (packed_bytes() > budget) return too_few_bytes();
        const auto pack_at = [&](double density) -> Result<PackedSize> {
            density_ = density;
            LUMEL_TRY(const bool fits, try_pages(limit));
            return PackedSize{fits ? packed_bytes() : std::numeric_limits<double>::infinity(),
                              sized_.clamped.size() == instances_.size()};
        };
        LUMEL_TRY(const double best, densest_within(budget, density_, even, pack_at));
        if (best != density_) {
            density_ = best;
            LUMEL_TRY_STATUS(try_pages(limit));
        }
        report_clamped();
        return success();
    }

    // What atlas_bytes counts.
    [[nodiscard]] double packed_bytes() const {
        std::vector<AtlasPage> pages;
        for (const PackPage& page : packing_.pages) pages.push_back({page.width * cell(), page.height * cell()});
        return options_.bytes_per_texel * static_cast<double>(texels_with_mips(pages, options_.masks));
    }

    [[nodiscard]] Error too_few_bytes() const {
        const auto least = static_cast<std::uint64_t>(std::ceil(packed_bytes()));
        return {ErrorCode::usage,
                "the " + std::to_string(instances_.size()) + " charts, each as small as can be, take " +
                    std::to_string(least) + " bytes, and --atlas-bytes allows " + std::to_string(options_.atlas_bytes),
                scene_.source,
                "ask for --atlas-bytes " + std::to_string(least) + " at least" +
                    (options_.masks.mips > 0 ? ", or for fewer --mips" : "")};
    }

    // One page of a given size, at the density asked or the highest that fits: from an all but full page down in steps
    // of three percent of its texels.
    Status fit_resolution() {
        constexpr double kStep = 0.97;
        const SizeLimit limit =
            SizeLimit::of_page(options_.resolution_width, options_.resolution_height, options_.masks);
        if (limit.width < 2 || limit.height < 2) return no_room();
        if (options_.texels_per_metre > 0.0) {
            density_ = options_.texels_per_metre;
            LUMEL_TRY(const bool fits, try_resolution(limit));
            return fits ? success() : no_room();
        }
        const double page = page_texels();
        const double least = least_texels(instances_, BudgetOf::page, options_.masks);
        for (double texels = 0.99 * page; texels > least; texels *= kStep) {
            LUMEL_TRY(density_, solve_density(charts_, instances_, texels, BudgetOf::page, limit, context_));
            LUMEL_TRY(const bool fits, try_resolution(limit));
            if (fits) return success();
        }
        return no_room();
    }

    // What is still the same stays where it was, at the density of then; the rest goes around it.
    Status keep_previous(const AtlasRecord& record) {
        const bool fixed = options_.resolution_width != 0;
        const std::uint32_t most_x = fixed ? options_.resolution_width : options_.max_page;
        const std::uint32_t most_y = fixed ? options_.resolution_height : options_.max_page;
        const SizeLimit limit = SizeLimit::of_page(most_x, most_y, options_.masks);
        if (limit.width < 2 || limit.height < 2) return no_room();
        density_ = record.density;
        std::vector<std::uint32_t> found = find_in_record(record, chart_names(scene_, charts_));
        std::vector<std::array<std::uint32_t, 2>> sizes(instances_.size());
        std::vector<PackSpot> spots(instances_.size(), {kNone, 0, 0});
        for (std::size_t k = 0; k < instances_.size(); ++k) {
            if (found[k] == kNone) continue;
            const AtlasRecord::Chart& then = record.charts[found[k]];
            if (!has_size(charts_, instances_[k], density_, limit, then.box.width, then.box.height)) continue;
            sizes[k] = {then.box.width, then.box.height};
            spots[k] = {then.page, then.box.x / cell(), then.box.y / cell()};
        }
        // New charts are drawn at that density: only a chart of then that has it vouches for it.
        if (std::ranges::all_of(spots, [](const PackSpot& spot) { return spot.page == kNone; }))
            return nothing_kept(record);
        LUMEL_TRY_STATUS(draw(limit, sizes));
        std::vector<PackPage> pages;
        for (const AtlasPage& page : record.pages) pages.push_back({page.width / cell(), page.height / cell(), 0});
        if (const std::size_t dropped = drop_conflicts(sized_.masks, items(), pages, spots); dropped > 0)
            context_.diagnostics.add("atlas-conflict",
                                     "charts of the layout to keep lie on top of each other or off their page: they "
                                     "were packed anew",
                                     record.where, dropped);
        for (const PackSpot& spot : spots) kept_ += spot.page != kNone ? 1 : 0;
        packing_ = pack_around(sized_.masks, items(), spots, pages, fixed ? 0 : options_.max_page / cell(), context_);
        if (context_.cancelled()) return cancelled_error();
        if (!packing_.complete) return no_room();
        report_clamped();
        return success();
    }

    [[nodiscard]] Error nothing_kept(const AtlasRecord& record) const {
        char density[32];
        std::snprintf(density, sizeof density, "%.4g", record.density);
        return {ErrorCode::usage,
                "its layout cannot be kept: none of its " + std::to_string(record.charts.size()) +
                    " charts is one of this scene, with the texels that " + density + " per metre give it",
                record.where, "leave out --atlas, or give the layout of an earlier state of this scene"};
    }

    Result<bool> try_resolution(SizeLimit limit) {
        LUMEL_TRY_STATUS(draw(limit));
        if (static_cast<double>(sized_.used) > page_texels()) return false;
        packing_ = pack_one_page(sized_.masks, items(), options_.resolution_width / cell(),
                                 options_.resolution_height / cell(), context_);
        if (context_.cancelled()) return cancelled_error();
        if (packing_.complete) report_clamped();
        return packing_.complete;
    }

    [[nodiscard]] std::uint32_t cell() const { return options_.masks.cell(); }
    [[nodiscard]] double page_texels() const {
        return static_cast<double>(options_.resolution_width) * options_.resolution_height;
    }

    [[nodiscard]] Error no_room() const {
        const bool fixed = options_.resolution_width != 0;
        const std::string size = std::to_string(fixed ? options_.resolution_width : options_.max_page) + "x" +
                                 std::to_string(fixed ? options_.resolution_height : options_.max_page);
        const std::string pages = options_.pages > 1 ? std::to_string(options_.pages) + " pages of " : "one page of ";
        return {ErrorCode::usage,
                "the " + std::to_string(instances_.size()) + " charts do not fit " + pages + size + " texels",
                scene_.source,
                options_.previous                 ? "leave out --atlas: there is no room beside the charts that stay"
                : options_.pages > 0              ? "raise --pages or --max-page, or lower the density"
                : options_.texels_per_metre > 0.0 ? "lower --texels-per-metre, or leave it out to have it solved"
                : options_.atlas_bytes > 0        ? "raise --max-page or --pages, or ask for fewer --mips"
                                                  : "ask for a larger --resolution, or none to have several pages"};
    }

    Status draw(SizeLimit limit, std::span<const std::array<std::uint32_t, 2>> fixed = {}) {
        const std::uint64_t bytes = mask_bytes(charts_, instances_, density_, limit, fixed);
        if (bytes > options_.max_mask_bytes) return too_dense(bytes);
        std::optional<SizedCharts> sized = size_charts(charts_, instances_, density_, limit, context_, fixed);
        if (!sized) return cancelled_error();
        sized_ = std::move(*sized);
        return success();
    }

    [[nodiscard]] Error too_dense(std::uint64_t bytes) const {
        const auto megabytes = [](std::uint64_t b) { return std::to_string((b + (1u << 20) - 1) >> 20) + " MB"; };
        char density[32];
        std::snprintf(density, sizeof density, "%.4g", density_);
        return {ErrorCode::out_of_memory,
                "the masks of " + std::to_string(instances_.size()) + " charts at " + density +
                    " texels per metre take " + megabytes(bytes) + ", and " + megabytes(options_.max_mask_bytes) +
                    " are allowed",
                scene_.source,
                options_.previous          ? "leave out --atlas, whose density that is"
                : options_.atlas_bytes > 0 ? "lower --atlas-bytes"
                                           : "lower --texels-per-metre"};
    }

    [[nodiscard]] std::vector<PackItem> items() const {
        std::vector<PackItem> out;
        out.reserve(instances_.size());
        for (std::size_t k = 0; k < instances_.size(); ++k) out.push_back({sized_.mask_of[k], instances_[k].instance});
        return out;
    }

    // Where each instance that has charts is, and how many cells they take.
    [[nodiscard]] std::vector<PackPlace> places() const {
        const std::vector<Vec3> centres = instance_centres(scene_, geometry_);
        std::vector<PackPlace> out;
        for (std::size_t k = 0; k < instances_.size(); ++k) {
            const std::uint32_t i = instances_[k].instance;
            if (k == 0 || instances_[k - 1].instance != i) out.push_back({i, centres[i], 0});
            out.back().used += sized_.masks[sized_.mask_of[k]].used;
        }
        return out;
    }

    void report_clamped() {
        char text[160];
        std::snprintf(text, sizeof text,
                      "charts larger than a page got fewer than %.4g texels per metre, one of them no more than %.4g",
                      density_, sized_.least);
        for (const std::uint32_t k : sized_.clamped)
            context_.diagnostics.add("chart-clamped", text, scene_.instances[instances_[k].instance].name);
    }

    [[nodiscard]] ChartPlacement placement(std::size_t k) const {
        const auto [width, height] = sized_.sizes[sized_.mask_of[k]];
        const Chart& chart = charts_.meshes[instances_[k].mesh].charts[instances_[k].chart];
        const PackSpot& spot = packing_.spots[k];
        const std::uint32_t x = spot.x * cell(), y = spot.y * cell();
        const double inset = options_.masks.inset() - 0.5;
        const TexelMap map = fit_to_centres(chart.min, chart.max, width, height, x + inset, y + inset);
        return {spot.page,
                {static_cast<float>(map.scale_x), static_cast<float>(map.scale_y)},
                {static_cast<float>(map.offset_x), static_cast<float>(map.offset_y)},
                {x, y, width, height}};
    }

    const Scene& scene_;
    const WorldGeometry& geometry_;
    const ChartSet& charts_;
    const ChartOptions& options_;
    Context& context_;
    std::vector<ChartInstance> instances_;
    double density_ = 0.0;
    SizedCharts sized_;
    Packing packing_;
    std::uint64_t kept_ = 0;
};

}  // namespace

double mip_sum(const MaskRule& masks) {
    double sum = 1.0;
    for (std::uint32_t mip = 1; mip <= masks.mips; ++mip) sum += std::ldexp(1.0, -2 * static_cast<int>(mip));
    return sum;
}

std::uint64_t texels_with_mips(std::span<const AtlasPage> pages, const MaskRule& masks) {
    std::uint64_t out = 0;
    for (const AtlasPage& page : pages)
        for (std::uint32_t mip = 0; mip <= masks.mips; ++mip)
            out += std::uint64_t{page.at_mip(mip).width} * page.at_mip(mip).height;
    return out;
}

Result<Atlas> make_atlas(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                         const ChartOptions& options, Context& context) {
    if (options.previous) LUMEL_TRY_STATUS(check_record(*options.previous, charts, options));
    LUMEL_TRY_STATUS(check_byte_budget(options, charts.scene_wide));
    if (charts.scene_wide) return kept_atlas(scene, geometry, charts, options);
    LUMEL_TRY_STATUS(check_masks(options));
    LUMEL_TRY_STATUS(check_page_choice(options));
    return AtlasMaker(scene, geometry, charts, options, context).run();
}

Atlas::TriangleUv Atlas::triangle_uv(const ChartSet& charts, const WorldGeometry& geometry, const Scene& scene,
                                     std::uint32_t world_triangle) const {
    const WorldTriangle& triangle = geometry.triangles[world_triangle];
    return mesh_triangle_uv(charts, scene, triangle.instance, triangle.mesh_triangle);
}

Atlas::TriangleUv Atlas::mesh_triangle_uv(const ChartSet& charts, const Scene& scene, std::uint32_t instance,
                                          std::uint32_t mesh_triangle) const {
    if (first_placement[instance] == first_placement[instance + 1]) return {};
    const MeshCharts& mesh = charts.meshes[scene.instances[instance].mesh];
    const std::uint32_t chart = mesh.chart_of_triangle[mesh_triangle];
    if (chart == kNone) return {};
    const ChartPlacement& place = placements[first_placement[instance] + chart];
    TriangleUv out;
    out.page = place.page;
    for (std::size_t k = 0; k < 3; ++k) out.texels[k] = mesh.uv[mesh_triangle][k] * place.scale + place.offset;
    return out;
}

}  // namespace lumel
