// Which nodes get texels: the rule of docs/sidecar.md.
#pragma once

#include "io/sidecar.h"
#include "lumel/context.h"

namespace lumel {

struct ClassOfNode {
    NodeClass node_class = NodeClass::lightmap;
    const char* reason = "";  // why it is not a lightmap node; "" where it is one
    bool is_asked = false;    // by the sidecar or extras.lightmap
};

// The first that applies: the sidecar's class, extras.lightmap, skinned, animated, small, and else lightmap.
// `diagonal` is that of the instance's bounds in the world, `scene_diagonal` that of all instances.
ClassOfNode classify(const SceneNode& node, const NodeSettings& settings, double diagonal, double scene_diagonal);

// As the sidecar writes it: "lightmap", "volume", ...
const char* class_name(NodeClass node_class);

}  // namespace lumel
