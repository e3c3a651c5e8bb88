#include "io/lit_lights.h"

#include <set>

#include "io/json_edit.h"

namespace lumel {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";

Json lights_of(const Json& root) {
    const Json* extension = find_extension(root, kLights);
    const Json* lights = extension ? find(*extension, "lights") : nullptr;
    return lights ? *lights : Json::array();
}

void remove_light(Json& node, const Json& lights) {
    const Json* extension = find_extension(node, kLights);
    if (!extension) return;
    const std::uint32_t light = index_at(*extension, "light");
    erase_extension(node, kLights);
    Json& extras = node["extras"];
    if (!extras.is_null() && !extras.is_object()) extras = {{"value", extras}};
    if (light < lights.size()) extras["lumel"]["light"] = lights[light];
}

}  // namespace

void remove_baked_lights(const GltfDocument& document, const Scene& scene, Json& root) {
    if (array_size(root, "nodes") == 0) return;
    std::set<std::uint32_t> realtime;
    for (std::size_t i = 0; i < document.light_nodes.size(); ++i)
        if (scene.lights[i].bake != LightBake::all) realtime.insert(document.light_nodes[i]);
    const Json lights = lights_of(root);
    for (std::uint32_t n = 0; n < root["nodes"].size(); ++n)
        if (!realtime.count(n)) remove_light(root["nodes"][n], lights);
    if (nodes_use_extension(root, kLights)) return;
    erase_extension(root, kLights);
    drop_extension(root, kLights);
}

}  // namespace lumel
