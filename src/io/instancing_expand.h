// EXT_mesh_gpu_instancing written out: each instance becomes a node of its own.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "io/gltf_document_internal.h"

namespace lumel {

// Gives these nodes of `root` a child per instance, in the accessors' order, in place of their mesh and the extension.
// Returns the children by node. The accessors are those of `document`, which the reader has checked.
std::map<std::uint32_t, std::vector<std::uint32_t>> expand_instancing(const GltfDocument& document,
                                                                      const std::set<std::uint32_t>& nodes, Json& root);

}  // namespace lumel
