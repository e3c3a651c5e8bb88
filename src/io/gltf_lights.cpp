// Lights and cameras where their nodes put them; the scale of a node does not count.
#include "io/gltf_lights.h"

#include <cmath>

#include "base/try.h"

namespace lumel {
namespace {

Result<LightShape> light_shape(const std::string& type, const std::string& where) {
    if (type == "directional") return LightShape::sun;
    if (type == "point") return LightShape::point;
    if (type == "spot") return LightShape::spot;
    return invalid(where, "'type' is '" + type + "', which KHR_lights_punctual does not know");
}

Status read_cone(const Json& json, Light& light, const std::string& where) {
    LUMEL_TRY(const Json* spot, optional_object(json, "spot", where));
    if (!spot) return success();
    LUMEL_TRY(const double inner, number_or(*spot, "innerConeAngle", 0.0, where));
    LUMEL_TRY(const double outer, number_or(*spot, "outerConeAngle", 0.785398163397448, where));
    light.inner_cone = static_cast<float>(inner);
    light.outer_cone = static_cast<float>(outer);
    return success();
}

// The light as the root extension describes it, not placed yet.
Result<ReadLight> read_light(const Json& json, std::uint64_t index, const std::string& where) {
    ReadLight out;
    LUMEL_TRY(out.light_name, string_or(json, "name", "", where));
    out.light.name = out.light_name.empty() ? "light " + std::to_string(index) : out.light_name;
    LUMEL_TRY(const std::string type, required_string(json, "type", where));
    LUMEL_TRY(out.light.shape, light_shape(type, where));
    LUMEL_TRY(const auto color, (numbers_or<3>(json, "color", {1, 1, 1}, where)));
    LUMEL_TRY(const double intensity, number_or(json, "intensity", 1.0, where));
    LUMEL_TRY(const double range, number_or(json, "range", 0.0, where));
    for (std::size_t c = 0; c < 3; ++c) out.light.intensity[c] = static_cast<float>(color[c] * intensity);
    out.light.range = static_cast<float>(range);
    if (out.light.shape == LightShape::spot) LUMEL_TRY_STATUS(read_cone(json, out.light, where));
    return out;
}

Result<Camera> read_perspective(const Json& json, const std::string& where) {
    LUMEL_TRY(const Json* perspective, optional_object(json, "perspective", where));
    if (!perspective) return invalid(where, "is a perspective camera without 'perspective'");
    Camera camera;
    LUMEL_TRY(const double fov, number_or(*perspective, "yfov", 0.785398163397448, where));
    LUMEL_TRY(const double aspect, number_or(*perspective, "aspectRatio", 0.0, where));
    camera.vertical_fov = static_cast<float>(fov);
    camera.aspect = static_cast<float>(aspect);
    return camera;
}

}  // namespace

NodeFrame node_frame(const SceneNode& node) {
    const Affine m = node.world.rounded();
    return {normalize_or(m.columns[0], {1, 0, 0}), normalize_or(m.columns[1], {0, 1, 0}),
            normalize_or(m.columns[2], {0, 0, 1}), m.translation};
}

Result<std::vector<ReadLight>> read_lights(const GltfDocument& document, const std::vector<SceneNode>& nodes) {
    std::vector<ReadLight> out;
    const Json* extension = find_extension(document.root, "KHR_lights_punctual");
    for (const SceneNode& node : nodes) {
        if (!node.light) continue;
        const std::string where = document.where + ": node '" + node.name + "', KHR_lights_punctual";
        if (!extension) return invalid(where, "the document has no lights");
        LUMEL_TRY(const Json* json, element(*extension, "lights", *node.light, where));
        LUMEL_TRY(ReadLight read,
                  read_light(*json, *node.light, document.where + ": " + label("light", *node.light, *json)));
        const NodeFrame frame = node_frame(node);
        if (node.named) read.light.name = node.name;
        read.light.position = frame.origin;
        read.light.direction = -frame.z;
        read.node = node.index;
        out.push_back(std::move(read));
    }
    return out;
}

Result<std::vector<Camera>> read_cameras(const GltfDocument& document, const std::vector<SceneNode>& nodes,
                                         Diagnostics& diagnostics) {
    std::vector<Camera> out;
    for (const SceneNode& node : nodes) {
        if (!node.camera) continue;
        LUMEL_TRY(const Json* json,
                  element(document.root, "cameras", *node.camera, document.where + ": node '" + node.name + "'"));
        const std::string name = label("camera", *node.camera, *json);
        LUMEL_TRY(const std::string type, string_or(*json, "type", "perspective", document.where + ": " + name));
        if (type != "perspective") {
            diagnostics.add("skipped-camera", "Only perspective cameras are read", name);
            continue;
        }
        LUMEL_TRY(Camera camera, read_perspective(*json, document.where + ": " + name));
        const NodeFrame frame = node_frame(node);
        camera.name = node.name;
        camera.transform = {{frame.x, frame.y, frame.z}, frame.origin};
        out.push_back(std::move(camera));
    }
    return out;
}

}  // namespace lumel
