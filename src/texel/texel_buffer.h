// The texels of one page: which are covered, by which triangles, and where inside each the light is sampled.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "scene/world_geometry.h"

namespace lumel {

inline constexpr std::uint32_t kSamplesPerTexel = 64;  // sub-texel sample points, a Hammersley set

// A point on the surface from which a texel gathers light.
struct SamplePoint {
    std::uint32_t triangle = kNone;  // world triangle
    float b1 = 0.0f, b2 = 0.0f;
};

// What a page's `texel_at` (width * height entries, row by row) says of a pixel, which may lie outside: kNone there.
inline std::uint32_t texel_at_pixel(std::span<const std::uint32_t> texel_at, std::uint32_t width, std::uint32_t height,
                                    std::int32_t x, std::int32_t y) {
    if (x < 0 || y < 0) return kNone;
    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
    return column < width && row < height ? texel_at[std::size_t{row} * width + column] : kNone;
}

inline constexpr float kOneSurfaceCosine = 0.8660254f;  // 30 degrees

// One entry per covered texel, in row-major order. A texel is covered if a triangle overlaps its square by more than a
// touch (1/1024 of a texel); slivers, triangles between texel centres and triangles without area in UV space count. It
// is owned by one chart: the one with the most sample points in it, the first of equals.
struct TexelBuffer {
    std::uint32_t page = 0, width = 0, height = 0;
    std::vector<std::uint16_t> x, y;
    std::vector<std::uint64_t> valid;           // bit s: Hammersley point s lies in a triangle of this texel
    std::vector<std::uint32_t> first_triangle;  // per texel into `triangles`, plus one past the end
    std::vector<std::uint32_t> triangles;       // world triangles of the owner that overlap the texel, ascending
    std::vector<std::uint32_t> chart;           // the owner: index into Atlas::placements, so one per instance
    std::vector<Vec3> position;                 // of the representative point: the centre, or the sample nearest to it
    std::vector<Vec3> normal;                   // vertex normal there
    std::vector<float> world_size;              // metres across a texel: the longer edge of its parallelogram
    std::vector<std::uint32_t> texel_at;        // width*height: index of the covered texel there, or kNone

    [[nodiscard]] std::size_t size() const { return x.size(); }
    // The covered texel at a pixel; kNone where there is none, and beyond the page's sides.
    [[nodiscard]] std::uint32_t at(std::int32_t pixel_x, std::int32_t pixel_y) const {
        return texel_at_pixel(texel_at, width, height, pixel_x, pixel_y);
    }
    // Whether the light of one says something of the other's: one chart, and normals at most 30 degrees apart.
    [[nodiscard]] bool on_one_surface(std::size_t i, std::size_t j) const {
        return chart[i] == chart[j] && dot(normal[i], normal[j]) >= kOneSurfaceCosine;
    }
};

// Where Hammersley point `s` (0..63) lies in the unit square of a texel: at least 1/128 from its sides, so that no
// point falls on the rim of a chart that is aligned to the texels.
Vec2 subtexel_point(std::uint32_t s);

// Where a texel is covered whole, its light is gathered from the middle of it: the points shrink towards its centre
// into a square of this width, in texels. Under bilinear lookup a box of half a texel and one of a whole texel
// reproduce a shadow edge equally well (mean squared error 0.131 and 0.128 per unit step); the narrow one is the
// sharper, and is what Blender's Cycles bakes with. Texels on the rim of a chart gather from all of their square that
// is covered.
inline constexpr float kGatherFootprint = 0.5f;

// Where point `s` of a texel with the given valid points gathers, in the texel's unit square.
Vec2 gather_point(std::uint64_t valid, std::uint32_t s);

// Pages as triangle lists: which world triangles have texels on each page. Zero-area UV triangles count too.
std::vector<std::vector<std::uint32_t>> triangles_by_page(const Scene& scene, const WorldGeometry& geometry,
                                                          const ChartSet& charts, const Atlas& atlas);

// `page_triangles`: those of triangles_by_page. Diagnostics: "chart-overlap" for texels claimed by more than one chart.
// Error: cancelled.
Result<TexelBuffer> rasterize_page(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                   const Atlas& atlas, std::uint32_t page,
                                   std::span<const std::uint32_t> page_triangles, Context& context);

// What TexelBuffer::position and normal are those of.
SamplePoint representative_point(const TexelBuffer& texels, std::size_t texel, const Scene& scene,
                                 const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas);

// Where the points of a texel lie: of a texel that is covered whole in kGatherFootprint of it, or in all of it; or
// wherever bilinear lookups blend the texel in, a square of two texels, as densely as they weigh it.
enum class Footprint : std::uint8_t { gather, whole, lookup };

// Part of a footprint, in its own unit square.
struct FootprintPart {
    Vec2 low{0, 0}, high{1, 1};
};

// The points of a texel in one of its footprints.
struct TexelPoints {
    std::array<SamplePoint, kSamplesPerTexel> at;
    std::uint32_t count = 0;
    std::uint64_t valid = 0;                 // bit s: Hammersley point s is among them; 0 where one stands for all
    std::vector<std::uint32_t> triangles{};  // world triangles that they may lie in, ascending
};

// Expands the valid sample points of a texel, in order of s; at least one: where no Hammersley point lies inside a
// triangle it is the middle of the largest part that a triangle shares with the texel. Returns how many were written.
// Not of Footprint::lookup.
std::uint32_t sample_points(const TexelBuffer& texels, std::size_t texel, const Scene& scene,
                            const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas,
                            std::span<SamplePoint, kSamplesPerTexel> out, Footprint footprint = Footprint::gather);

// The Hammersley points of all or part of a texel's square (Footprint::whole) or of where it is looked up, that lie on
// its chart, and all that is known of them; there may be none. Not of Footprint::gather.
void texel_points(const TexelBuffer& texels, std::size_t texel, const Scene& scene, const WorldGeometry& geometry,
                  const ChartSet& charts, const Atlas& atlas, Footprint footprint, const FootprintPart& part,
                  TexelPoints& out);

}  // namespace lumel
