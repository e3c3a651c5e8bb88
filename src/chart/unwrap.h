// From meshes to charts: clusters, each laid flat, neighbours joined.
#pragma once

#include <cstdint>
#include <vector>

#include "chart/flatten.h"
#include "chart/topology.h"
#include "lumel/context.h"

namespace lumel {

struct UnwrapMesh {
    const Mesh* mesh;
    const MeshTopology* topology;
    std::vector<FlatChart> charts;  // filled by unwrap_meshes, in no particular order
    std::uint32_t fallbacks = 0;    // clusters that ended in the box projection
};

// False: cancelled. The same charts for any number of threads.
[[nodiscard]] bool unwrap_meshes(std::vector<UnwrapMesh>& meshes, Context& context);

}  // namespace lumel
