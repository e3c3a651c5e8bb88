// Charts of the baked meshes: who belongs to which chart, and where in the chart's own plane. And the atlas: where each
// chart of each instance lies on which page.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "chart/chart_mask.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "scene/world_geometry.h"

namespace lumel {

struct Chart {
    std::uint32_t first = 0, count = 0;  // into MeshCharts::order: the triangles of this chart
    Vec2 min{}, max{};                   // bounds of its UVs, chart units
};

// Chart units are metres in mesh space (isometric flattening), or units of TEXCOORD_1 for a kept scene-wide layout.
struct MeshCharts {
    std::vector<std::uint32_t> chart_of_triangle;  // kNone for zero-area triangles
    std::vector<std::array<Vec2, 3>> uv;           // per triangle corner
    std::vector<std::uint32_t> order;              // triangle ids grouped by chart
    std::vector<Chart> charts;
    bool from_uv1 = false;  // charts are the islands of the file's TEXCOORD_1
};

struct ChartSet {
    std::vector<MeshCharts> meshes;  // one per Scene::meshes; empty charts where no instance wants texels
    bool scene_wide = false;         // TEXCOORD_1 is one atlas of the whole scene and is kept unchanged
    std::vector<bool> demoted;       // per Scene::instances: of class volume because its charts are bad. Empty: none
    // Per Scene::instances and chart: no light gets there (path/sealed_charts.h), so that it is drawn at kSealedDensity
    // of what is asked. Empty, of the scene or of an instance: none.
    std::vector<std::vector<bool>> sealed = {};
    static constexpr double kSealedDensity = 0.25;

    // Which class an instance has, now that its charts are known.
    [[nodiscard]] NodeClass class_of(const Scene& scene, std::size_t instance) const {
        return !demoted.empty() && demoted[instance] ? NodeClass::volume : scene.instances[instance].node_class;
    }
    [[nodiscard]] bool gets_texels(const Scene& scene, std::size_t instance) const {
        return class_of(scene, instance) == NodeClass::lightmap;
    }
    [[nodiscard]] bool is_sealed(std::size_t instance, std::size_t chart) const {
        return !sealed.empty() && !sealed[instance].empty() && sealed[instance][chart];
    }
};

// Of a chart on its page, texels: where its mask begins, and how many its bounds span from centre to centre. Masks of
// the usual rule begin there, too. Without size for a kept layout.
struct ChartBox {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;

    bool operator==(const ChartBox&) const = default;
};

// uv_texels = uv_chart * scale + offset, in texels of `page` (texel centres at i + 0.5).
struct ChartPlacement {
    std::uint32_t page = kNone;  // kNone: not placed (no texels)
    Vec2 scale{1, 1};
    Vec2 offset{};
    ChartBox box = {};
};

struct AtlasPage {
    std::uint32_t width = 0, height = 0;

    // Of a mip that the rule of masks declares: pages are whole cells, so that nothing is rounded.
    [[nodiscard]] AtlasPage at_mip(std::uint32_t mip) const { return {width >> mip, height >> mip}; }
};

struct Atlas {
    std::vector<AtlasPage> pages;
    std::vector<std::uint32_t> first_placement;  // per Scene::instances, plus one past the end
    std::vector<ChartPlacement> placements;      // of instance i: [first_placement[i] + chart]
    // Reached: as asked or solved, lower where charts larger than a page had to shrink (mean over the area). The least
    // is that of the chart that shrank most. Both are 0 for a kept layout, which has many.
    double texels_per_metre = 0.0, least_texels_per_metre = 0.0;
    // As asked or solved; 0 for a kept layout. What a later layout that keeps this one draws new charts at.
    double density = 0.0;
    MaskRule masks;  // under which no two charts share texels; the usual one for a kept layout, which may not keep it
    std::uint64_t kept = 0;  // placements that are those of ChartOptions::previous

    // Lightmap UV of a triangle's corners in texels of the page, and that page; page kNone: no texels.
    struct TriangleUv {
        std::uint32_t page = kNone;
        std::array<Vec2, 3> texels{};
    };
    [[nodiscard]] TriangleUv triangle_uv(const ChartSet& charts, const WorldGeometry& geometry, const Scene& scene,
                                         std::uint32_t world_triangle) const;
    // The same by a triangle of the mesh of a baked instance.
    [[nodiscard]] TriangleUv mesh_triangle_uv(const ChartSet& charts, const Scene& scene, std::uint32_t instance,
                                              std::uint32_t mesh_triangle) const;
};

// Texels of a page and its mips over those of the page.
double mip_sum(const MaskRule& masks);

// Of all pages and their mips, those that no chart lies on among them.
std::uint64_t texels_with_mips(std::span<const AtlasPage> pages, const MaskRule& masks);

struct AtlasRecord;  // chart/atlas_record.h

enum class Uv1Policy : std::uint8_t { automatic, scene, mesh, ignore };

struct ChartOptions {
    Uv1Policy uv1 = Uv1Policy::automatic;
    std::uint32_t resolution_width = 0, resolution_height = 0;  // of the one page; 0 = free
    std::uint32_t max_page = 4096;                              // largest page edge, texels, 64..16384
    double texels_per_metre = 0.0;                              // 0: solved from the budget
    double texel_budget = 250000.0;                             // texels, where no density is asked
    // Instead of both: all texels of all pages and their mips, at so many bytes each, take no more than atlas_bytes (0:
    // not asked). Not with texels_per_metre, one page of a given resolution, `previous` or a TEXCOORD_1 that is kept.
    std::uint64_t atlas_bytes = 0;
    double bytes_per_texel = 1.0;
    // Charts of instances that are near each other share pages: as many as max_page asks for, or `pages` (0: not said).
    bool page_clusters = false;
    std::uint32_t pages = 0;
    // Beside Atlas::placements: width and height, in texels, that a chart's box has instead of what the density gives
    // it. 0 x 0, or an empty list: as the density says. Not with `previous`, nor with one page of a given resolution.
    std::vector<std::array<std::uint32_t, 2>> sizes;
    std::uint64_t max_mask_bytes = std::uint64_t{2} << 30;  // of all masks together, while charts are packed
    // What the runtime's lookups touch. A TEXCOORD_1 of the whole scene is kept only under the usual rule.
    MaskRule masks;
    // Charts that are still the same keep their places (chart/atlas_record.h). None: all are packed anew.
    const AtlasRecord* previous = nullptr;
};

// Two triangles of a TEXCOORD_1 that lie on top of each other.
struct UvOverlap {
    std::uint32_t instance_a = 0, triangle_a = 0;  // mesh triangles
    std::uint32_t instance_b = 0, triangle_b = 0;
};

// Charts of every mesh some lightmap instance uses. Deterministic for any thread count.
// Diagnostics: "uv1-rejected" (why a mesh's TEXCOORD_1 was not kept), "uv1-repacked" (why it was not kept as one atlas
// of the scene), "uv-overlap" (pairs of triangles), "uv-bleeding" (pairs of charts of a kept atlas that share texels
// under bilinear filtering), "unwrap-fallback", "bad-charts" (instances that got class volume: chart/bad_charts.h).
// Errors: usage where Uv1Policy::scene was asked and some TEXCOORD_1 is missing or leaves [0, 1], or where the rule of
// masks is not the usual one, which a layout that stays as it is could not follow.
Result<ChartSet> make_charts(const Scene& scene, const WorldGeometry& geometry, const ChartOptions& options,
                             Context& context);

// Places the charts of every lightmap instance. Errors: usage where they cannot fit the asked resolution, where the
// masks are of a rule that cannot be, or the resolution is no multiple of its cells, and where the options do not allow
// to keep the previous layout, or where atlas_bytes hold no layout of these charts (the least that do are named);
// out_of_memory where the masks at this density would take more than
// ChartOptions::max_mask_bytes: before any is drawn.
// Diagnostics: "chart-clamped" (nodes with charts larger than a page, and the density that is left to them).
Result<Atlas> make_atlas(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                         const ChartOptions& options, Context& context);

}  // namespace lumel
