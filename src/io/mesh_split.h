// Cuts a mesh for its lightmap: one part per primitive and page, vertices doubled only where corner UVs differ.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "lumel/scene.h"

namespace lumel {

// The triangles of one primitive whose charts lie on one page. What it holds does not depend on where the charts lie,
// so instances whose charts are spread over pages in the same way share it.
struct MeshPart {
    std::uint32_t primitive = 0;           // into Mesh::primitives
    std::uint32_t group = kNone;           // as given for the charts; kNone: no lightmap
    std::vector<std::uint32_t> triangles;  // of the mesh, ascending
    // Per vertex of the part, ordered by element, then by first use.
    std::vector<std::uint32_t> element;      // of the glTF primitive's attribute accessors
    std::vector<std::uint32_t> mesh_vertex;  // one of the mesh's vertices that it stands for
    std::vector<std::uint32_t> chart;        // kNone for vertices that only zero-area triangles use
    std::vector<Vec2> chart_uv;
    std::vector<std::uint32_t> corner;   // 3 * (position in `triangles`) + corner of its first use
    std::vector<std::uint32_t> indices;  // 3 per triangle
};

// `group_of_chart` says with which number a chart's triangles go (its page by rank). Zero-area triangles, which have no
// chart, go with the lowest group of their primitive. `element_of_vertex` maps mesh vertices to elements of the file's
// accessors: vertices that the loader doubled are one again.
std::vector<MeshPart> split_mesh(const Mesh& mesh, const MeshCharts& charts,
                                 std::span<const std::uint32_t> group_of_chart,
                                 std::span<const std::uint32_t> element_of_vertex);

}  // namespace lumel
