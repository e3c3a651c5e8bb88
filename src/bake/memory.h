// What a bake takes: predicted before it starts, measured after.
#pragma once

#include <cstdint>

#include "chart/chart_set.h"
#include "scene/world_geometry.h"

namespace lumel {

// Geometry, acceleration structure, textures and charts: what lives through the whole bake.
std::uint64_t scene_memory(const Scene& scene, const WorldGeometry& geometry);

// The largest page: texel buffer, sums, lightmap and the writers' rows.
std::uint64_t page_memory(const AtlasPage& page);
std::uint64_t largest_page_memory(const Atlas& atlas);

// High-water mark of the process's resident memory.
std::uint64_t peak_memory();

}  // namespace lumel
