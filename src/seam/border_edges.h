// The borders of all charts in world space: where two sides of one line may look up different texels.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/chart_set.h"
#include "scene/world_geometry.h"

namespace lumel {

// An edge of a triangle across which the layout does not go on.
struct BorderEdge {
    Vec3 from, to;                    // world space, metres
    Vec3 normal_from{}, normal_to{};  // unit: the vertex normals, with which the runtime shades
    Vec3 inward{};                    // unit: in the triangle's plane, off the edge into the triangle
    Vec2 texels_from{}, texels_to{};  // lightmap UV, texels of the page
    std::uint32_t page = kNone, triangle = kNone;
};

// Of all instances that have texels, in their order. Edges of no length in space are left out.
std::vector<BorderEdge> find_border_edges(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                          const Atlas& atlas);

// How many there are, or a few more: edges of no length, and of charts that were not placed, count too. For what they
// will take of memory, before there is an atlas.
std::uint64_t count_border_edges(const Scene& scene, const ChartSet& charts);

}  // namespace lumel
