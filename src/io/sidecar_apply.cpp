// The sidecar meets the scene: names are found, area lights placed, settings inherited.
#include <algorithm>
#include <cmath>

#include "base/try.h"
#include "io/data_uri.h"
#include "io/image_io.h"
#include "io/json_read.h"
#include "io/sidecar.h"

namespace lumel {
namespace {

// At most ten names, for the remedy of a misspelt one.
std::string known_names(const std::vector<std::string>& names) {
    if (names.empty()) return "the scene has none";
    std::string out = "the scene has: ";
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 10); ++i) out += (i ? ", '" : "'") + names[i] + "'";
    return names.size() > 10 ? out + ", ..." : out;
}

Status apply(const LightSettings& settings, Light& light, const std::string& where) {
    const bool has_radius = light.shape == LightShape::point || light.shape == LightShape::spot;
    if (settings.radius && !has_radius)
        return invalid(where, "'radius' is for point and spot lights", "a sun has 'angle_degrees'");
    if (settings.angular_diameter && light.shape != LightShape::sun)
        return invalid(where, "'angle_degrees' is for suns", "a point or spot light has 'radius'");
    light.radius = settings.radius.value_or(light.radius);
    light.angular_diameter = settings.angular_diameter.value_or(light.angular_diameter);
    light.bake = settings.bake.value_or(light.bake);
    light.indirect_scale = settings.indirect_scale.value_or(light.indirect_scale);
    light.indirect_color = settings.indirect_color.value_or(light.indirect_color);
    return success();
}

// `up` made perpendicular to the direction; any perpendicular where it is absent or parallel.
Vec3 upright(Vec3 direction, Vec3 up) {
    const Vec3 across = up - direction * dot(up, direction);
    const Vec3 other = std::fabs(direction.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
    const Vec3 fallback = normalize(other - direction * dot(other, direction));
    return length(across) > 1e-4f ? normalize(across) : fallback;
}

void place(const SidecarAreaLight& area, Vec3 position, Vec3 direction, Vec3 up, Light& light) {
    light.position = position;
    light.direction = direction;
    const Vec3 v = upright(direction, up);
    const Vec3 u = cross(v, direction);  // u x v = direction
    if (light.shape == LightShape::rectangle) {
        light.half_u = u * (0.5f * area.width);
        light.half_v = v * (0.5f * area.height);
    } else if (light.shape == LightShape::disc) {
        light.half_u = u * area.radius;
        light.half_v = v * area.radius;
    }
    light.radius = light.shape == LightShape::rectangle ? 0.0f : area.radius;
}

std::vector<std::string> names_of(const std::vector<SceneNode>& nodes) {
    std::vector<std::string> names;
    names.reserve(nodes.size());
    for (const SceneNode& node : nodes) names.push_back(node.name);
    return names;
}

Result<Light> placed(const SidecarAreaLight& area, const std::vector<SceneNode>& nodes, const std::string& sidecar) {
    Light light = area.light;
    if (area.node.empty()) {
        place(area, area.position, area.direction, area.up.value_or(Vec3{}), light);
        return light;
    }
    const auto node = std::find_if(nodes.begin(), nodes.end(), [&](const SceneNode& n) { return n.name == area.node; });
    if (node == nodes.end())
        return invalid(sidecar + ": " + light.name, "there is no node '" + area.node + "'",
                       known_names(names_of(nodes)));
    const NodeFrame frame = node_frame(*node);
    place(area, frame.origin, -frame.z, frame.y, light);
    return light;
}

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& scene) {
    std::filesystem::path path = scene;
    return path.replace_extension(".lumel.json");
}

Status apply_lights(const Sidecar& sidecar, const std::vector<SceneNode>& nodes, std::vector<ReadLight>& lights) {
    for (const auto& [name, settings] : sidecar.lights) {
        bool found = false;
        for (ReadLight& read : lights) {
            if (read.light.name != name && read.light_name != name) continue;
            found = true;
            LUMEL_TRY_STATUS(apply(settings, read.light, sidecar.where + ": lights '" + name + "'"));
        }
        if (found) continue;
        std::vector<std::string> names;
        names.reserve(lights.size());
        for (const ReadLight& read : lights) names.push_back(read.light.name);
        return invalid(sidecar.where, "there is no light '" + name + "'", known_names(names));
    }
    for (const SidecarAreaLight& area : sidecar.area_lights) {
        LUMEL_TRY(Light light, placed(area, nodes, sidecar.where));
        lights.push_back({std::move(light), {}, kNone});
    }
    return success();
}

Status apply_sky(const Sidecar& sidecar, const std::filesystem::path& directory, Sky& sky) {
    if (!sidecar.sky) return success();
    const SkySettings& settings = *sidecar.sky;
    sky.rotation = settings.rotation;
    sky.color = settings.color * settings.intensity;
    if (settings.map.empty()) return success();
    LUMEL_TRY(const std::filesystem::path path, resolve_uri(settings.map, directory, sidecar.where + ": sky"));
    LUMEL_TRY(sky.map, read_sky(path));
    for (Vec3& pixel : sky.map->radiance) pixel *= settings.intensity;
    return success();
}

namespace {

Status check_node_names(const Sidecar& sidecar, const std::vector<SceneNode>& nodes) {
    std::vector<std::string> names = names_of(nodes);
    std::sort(names.begin(), names.end());
    for (const auto& entry : sidecar.nodes)
        if (!std::binary_search(names.begin(), names.end(), entry.first))
            return invalid(sidecar.where, "there is no node '" + entry.first + "'", known_names(names_of(nodes)));
    return success();
}

}  // namespace

Result<std::vector<NodeSettings>> node_settings(const Sidecar& sidecar, const std::vector<SceneNode>& nodes) {
    LUMEL_TRY_STATUS(check_node_names(sidecar, nodes));
    std::map<std::uint32_t, std::size_t> position;  // glTF node -> into nodes
    for (std::size_t i = 0; i < nodes.size(); ++i) position.emplace(nodes[i].index, i);
    std::vector<NodeSettings> out(nodes.size());
    std::vector<bool> settled(nodes.size());
    std::vector<std::size_t> chain;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        // Up to the first ancestor that is settled, then down again, each taking what it lacks from its parent.
        NodeSettings inherited;
        for (auto at = position.find(nodes[i].index); at != position.end();
             at = position.find(nodes[at->second].parent)) {
            if (settled[at->second]) {
                inherited = out[at->second];
                break;
            }
            chain.push_back(at->second);
        }
        for (; !chain.empty(); chain.pop_back()) {
            const std::size_t n = chain.back();
            if (const auto own = sidecar.nodes.find(nodes[n].name); own != sidecar.nodes.end()) {
                if (own->second.node_class) inherited.node_class = own->second.node_class;
                if (own->second.texel_density) inherited.texel_density = own->second.texel_density;
            }
            out[n] = inherited;
            settled[n] = true;
        }
    }
    return out;
}

}  // namespace lumel
