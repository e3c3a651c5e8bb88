// Places in a scene and in a layout, as messages name them.
#pragma once

#include <cstdint>
#include <string>

#include "lumel/scene.h"

namespace lumel {

// "node 'a' (mesh 'm')"; by number where the node has no name.
std::string node_and_mesh(const Scene& scene, std::uint32_t instance);

// "(0.2500, 0.5000)".
std::string uv_text(Vec2 uv);

}  // namespace lumel
