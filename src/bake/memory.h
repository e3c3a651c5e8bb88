// What a bake takes of memory, predicted before it starts.
#pragma once

#include <cstdint>

#include "chart/chart_set.h"
#include "scene/world_geometry.h"

namespace lumel {

// Acceleration structure, at the peak of its build; the tree of emissive triangles.
std::uint64_t tracer_memory(const WorldGeometry& geometry);
std::uint64_t light_memory(const WorldGeometry& geometry);

// Geometry, lights, acceleration structure, textures, charts: what lives as long as pages are baked, and again while
// views of the result are rendered.
std::uint64_t scene_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas);

// One page while it is baked and written: texel buffer, sums, lightmap, rows of the files on so many threads.
std::uint64_t page_memory(const AtlasPage& page, unsigned threads);

// All that `lumel bake` takes at its peak, which is either the largest page or the scene.glb and the manifest at the
// end.
std::uint64_t bake_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas, unsigned threads);

}  // namespace lumel
