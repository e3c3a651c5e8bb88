// KHR_lights_punctual and cameras, placed by their nodes.
#pragma once

#include <vector>

#include "io/gltf_nodes.h"
#include "lumel/context.h"

namespace lumel {

struct ReadLight {
    Light light;                 // named after its node, or after itself where the node has no name
    std::string light_name;      // its own name in the file; may be empty
    std::uint32_t node = kNone;  // whose it is; kNone for those of the sidecar
};

Result<std::vector<ReadLight>> read_lights(const GltfDocument& document, const std::vector<SceneNode>& nodes);

// Perspective cameras. Diagnostics: "skipped-camera" (orthographic).
Result<std::vector<Camera>> read_cameras(const GltfDocument& document, const std::vector<SceneNode>& nodes,
                                         Diagnostics& diagnostics);

// Axes of a node without its scale: unit length, as glTF places lights and cameras.
struct NodeFrame {
    Vec3 x, y, z, origin;
};
NodeFrame node_frame(const SceneNode& node);

}  // namespace lumel
