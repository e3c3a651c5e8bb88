// What a bake takes of memory, predicted before it starts.
#pragma once

#include <cstdint>
#include <optional>

#include "chart/chart_set.h"
#include "scene/world_geometry.h"

namespace lumel {

// Acceleration structure, at the peak of its build; the tree of emissive triangles.
std::uint64_t tracer_memory(const WorldGeometry& geometry);
std::uint64_t light_memory(const WorldGeometry& geometry);

// Geometry, lights, acceleration structure, textures, charts: what lives as long as pages are baked and views of
// the result are rendered.
std::uint64_t scene_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas);

// One page while it is baked and written: texel buffer, sums, lightmap, rows of the files on so many threads; then its
// mips, one at a time. `seams`: they are made equal.
std::uint64_t page_memory(const AtlasPage& page, std::uint32_t mips, bool seams, unsigned threads);

// Surface cells: what stays while pages are baked, and what comes on top while they are lit.
struct CellMemory {
    std::uint64_t cells = 0, links = 0;
};
CellMemory cell_memory(const WorldGeometry& geometry, const Atlas& atlas, std::uint32_t samples);

// Seams that are made equal: what stays while pages are baked, and what comes on top while they are looked for.
struct SeamMemory {
    std::uint64_t samples = 0, finding = 0;
};
SeamMemory seam_memory(std::uint64_t border_edges, const Atlas& atlas);

struct MemoryPlan {
    std::uint32_t cell_samples = 0;             // samples per texel of a bake with cells, else 0
    std::optional<std::uint64_t> border_edges;  // of the charts (count_border_edges); none: seams are left as they are
    bool keeps_pages = false;                   // all until the last is baked (BakeOptions::collapse)
};

// All that `lumel bake` takes at its peak, which is the largest page, or the cells while they are lit, or the search
// for seams, or the scene.glb and the manifest at the end.
std::uint64_t bake_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas, const MemoryPlan& plan,
                          unsigned threads);

}  // namespace lumel
