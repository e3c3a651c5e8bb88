#include "chart/where.h"

#include <cstdio>

namespace lumel {

std::string node_and_mesh(const Scene& scene, std::uint32_t instance) {
    const Instance& i = scene.instances[instance];
    const std::string& mesh = scene.meshes[i.mesh]->name;
    return (i.name.empty() ? "node " + std::to_string(instance) : "node '" + i.name + "'") +
           (mesh.empty() ? "" : " (mesh '" + mesh + "')");
}

std::string uv_text(Vec2 uv) {
    char text[48];
    std::snprintf(text, sizeof text, "(%.4f, %.4f)", double{uv.x}, double{uv.y});
    return text;
}

}  // namespace lumel
