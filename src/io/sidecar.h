// `<scene>.lumel.json`: what glTF cannot say (docs/sidecar.md). Parsing is apart from applying, so that hostile bytes
// meet the parser alone.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf_lights.h"
#include "io/gltf_nodes.h"
#include "lumel/scene.h"

namespace lumel {

struct LightSettings {
    std::optional<float> radius;            // metres; point and spot lights
    std::optional<float> angular_diameter;  // radians; suns
    std::optional<LightBake> bake;
    std::optional<float> indirect_scale;
    std::optional<Vec3> indirect_color;
};

struct NodeSettings {
    std::optional<NodeClass> node_class;
    std::optional<float> texel_density;  // times the bake's
};

// An area light in its own frame (lit side along -Z, width along X, height along Y) until it is placed.
struct SidecarAreaLight {
    Light light;       // shape, intensity and artist controls
    std::string node;  // placed by this node, or else:
    Vec3 position{}, direction{0, -1, 0};
    std::optional<Vec3> up;
    float width = 0.0f, height = 0.0f, radius = 0.0f;
};

struct SkySettings {
    Vec3 color{};            // nits where there is no map
    std::string map;         // file beside the sidecar
    float intensity = 1.0f;  // nits per unit of colour or map
    float rotation = 0.0f;   // radians
};

struct Sidecar {
    std::string where;
    std::map<std::string, LightSettings> lights;  // by name of the light or its node
    std::map<std::string, NodeSettings> nodes;    // by name of the node
    std::vector<SidecarAreaLight> area_lights;
    std::optional<SkySettings> sky;
};

// Unknown keys and values out of range are errors that name the key.
Result<Sidecar> parse_sidecar(std::string_view text, const std::string& where);

// `room.glb` -> `room.lumel.json`.
std::filesystem::path sidecar_path(const std::filesystem::path& scene);

// Applies lights and area lights. Errors: a name that the scene does not have.
Status apply_lights(const Sidecar& sidecar, const std::vector<SceneNode>& nodes, std::vector<ReadLight>& lights);
// Reads the sky's map (from `directory`) and scales it to nits.
Status apply_sky(const Sidecar& sidecar, const std::filesystem::path& directory, Sky& sky);
// Settings in force at each node: its own, or those of the nearest ancestor that has them. One entry per node.
Result<std::vector<NodeSettings>> node_settings(const Sidecar& sidecar, const std::vector<SceneNode>& nodes);

}  // namespace lumel
