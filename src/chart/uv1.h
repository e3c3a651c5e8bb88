// Is a file's TEXCOORD_1 fit to be a lightmap layout, of one mesh or of the whole scene; and its islands as charts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chart/chart_set.h"
#include "chart/overlap.h"

namespace lumel {

// Corners of every triangle in TEXCOORD_1. Precondition: the mesh has it.
std::vector<UvTriangle> uv1_triangles(const Mesh& mesh);

// Overlaps narrower than 1/16384 of the page (a quarter of a texel of the largest page that is usual, 4096) and
// narrower than a tenth of the thinner triangle are what quantised coordinates make of layouts that touch: they do not
// count.
OverlapTolerance uv1_tolerance();

struct Uv1Verdict {
    std::string reason;                                  // empty: fit
    std::vector<std::array<std::uint32_t, 2>> overlaps;  // pairs of triangles, kMaxOverlaps at most
    [[nodiscard]] bool fit() const { return reason.empty(); }
};
inline constexpr std::size_t kMaxOverlaps = 10000;  // pairs after which the search stops counting

// Present, finite, inside [0, 1], with area where the surface has area, and without overlaps. `areas` are the mesh's
// triangle areas, 0 for those that need no texels.
Uv1Verdict judge_uv1(const Mesh& mesh, const std::vector<double>& areas);

// The parts of the verdict that one triangle list cannot share with another: everything but overlaps.
std::string judge_uv1_coordinates(const Mesh& mesh, const std::vector<double>& areas);

// Islands as charts, coordinates times `scale`. Triangles are of one island where they share a corner in UV and in
// space: what only touches in the layout is two.
MeshCharts uv1_islands(const Mesh& mesh, const std::vector<double>& areas, float scale);

// sqrt(surface area / UV area) of the triangles that have area.
double uv1_scale(const Mesh& mesh, const std::vector<double>& areas);

}  // namespace lumel
