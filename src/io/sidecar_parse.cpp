// The sidecar as text: keys, types and ranges (docs/sidecar.md).
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/try.h"
#include "io/json_read.h"
#include "io/sidecar.h"

namespace lumel {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;

// Colours may be spelt both ways: the British key of one that ends in "color", else nothing.
std::string british(std::string_view key) {
    constexpr std::string_view kAmerican = "color";
    return key.ends_with(kAmerican) ? std::string(key.substr(0, key.size() - 1)) + "ur" : std::string();
}

// Every object is checked for keys that Lumel does not know: a misspelt setting must not be silently without effect.
Status check_keys(const Json& object, std::initializer_list<std::string_view> known, const std::string& where) {
    if (!object.is_object()) return invalid(where, "must be an object");
    for (auto member = object.begin(); member != object.end(); ++member) {
        const auto is_member = [&](std::string_view key) {
            const std::string other = british(key);
            return member.key() == key || (!other.empty() && member.key() == other);
        };
        if (std::any_of(known.begin(), known.end(), is_member)) continue;
        std::string list;
        for (const std::string_view key : known) list += (list.empty() ? "" : ", ") + std::string(key);
        return invalid(where, "unknown key '" + member.key() + "'", "known keys: " + list);
    }
    return success();
}

Result<std::optional<float>> number_in(const Json& object, const char* key, double least, double most,
                                       const std::string& where) {
    if (!find(object, key)) return std::optional<float>{};
    LUMEL_TRY(const double value, number_or(object, key, 0.0, where));
    if (value < least || value > most)
        return invalid(where, std::string("'") + key + "' is " + std::to_string(value) + ", not within " +
                                  std::to_string(least) + " and " + std::to_string(most));
    return std::optional<float>(static_cast<float>(value));
}

Result<std::optional<Vec3>> vector_of(const Json& object, const char* key, const std::string& where) {
    if (!find(object, key)) return std::optional<Vec3>{};
    LUMEL_TRY(const auto v, (numbers_or<3>(object, key, {}, where)));
    return std::optional<Vec3>(Vec3{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
}

Result<std::optional<Vec3>> color_of(const Json& object, const char* american, const std::string& where) {
    const std::string other = british(american);
    const bool is_british = find(object, other.c_str()) != nullptr;
    if (is_british && find(object, american))
        return invalid(where, std::string("has both '") + american + "' and '" + other + "'", "keep one of them");
    const char* key = is_british ? other.c_str() : american;
    LUMEL_TRY(const std::optional<Vec3> color, vector_of(object, key, where));
    if (color && std::min({color->x, color->y, color->z}) < 0.0f)
        return invalid(where, std::string("'") + key + "' has a negative component");
    return color;
}

Result<std::optional<Vec3>> direction_of(const Json& object, const char* key, const std::string& where) {
    LUMEL_TRY(const std::optional<Vec3> v, vector_of(object, key, where));
    if (!v) return v;
    const Vec3 unit = normalize_or(*v, Vec3{});
    if (unit == Vec3{}) return invalid(where, std::string("'") + key + "' has no direction");
    return std::optional<Vec3>(unit);
}

template <class T>
struct Choice {
    const char* name;
    T value;
};

template <class T>
Result<std::optional<T>> choice_of(const Json& object, const char* key, std::initializer_list<Choice<T>> choices,
                                   const std::string& where) {
    if (!find(object, key)) return std::optional<T>{};
    LUMEL_TRY(const std::string name, string_or(object, key, {}, where));
    std::string list;
    for (const Choice<T>& choice : choices) {
        if (name == choice.name) return std::optional<T>(choice.value);
        list += (list.empty() ? "" : ", ") + std::string(choice.name);
    }
    return invalid(where, std::string("'") + key + "' is '" + name + "'", "one of: " + list);
}

Status read_artist_controls(const Json& json, LightSettings& out, const std::string& where) {
    LUMEL_TRY(out.bake,
              choice_of<LightBake>(
                  json, "bake", {{"all", LightBake::all}, {"indirect", LightBake::indirect}, {"none", LightBake::none}},
                  where));
    LUMEL_TRY(out.indirect_scale, number_in(json, "indirect_scale", 0.0, 1e6, where));
    LUMEL_TRY(out.indirect_color, color_of(json, "indirect_color", where));
    return success();
}

Result<LightSettings> read_light(const Json& json, const std::string& where) {
    LUMEL_TRY_STATUS(check_keys(json, {"radius", "angle_degrees", "bake", "indirect_scale", "indirect_color"}, where));
    LightSettings out;
    LUMEL_TRY(out.radius, number_in(json, "radius", 0.0, 1e6, where));
    LUMEL_TRY(const auto angle, number_in(json, "angle_degrees", 0.0, 90.0, where));
    if (angle) out.angular_diameter = static_cast<float>(*angle * kRadiansPerDegree);
    LUMEL_TRY_STATUS(read_artist_controls(json, out, where));
    return out;
}

Result<NodeSettings> read_node(const Json& json, const std::string& where) {
    LUMEL_TRY_STATUS(check_keys(json, {"class", "texel_density"}, where));
    NodeSettings out;
    LUMEL_TRY(out.node_class, choice_of<NodeClass>(json, "class",
                                                   {{"lightmap", NodeClass::lightmap},
                                                    {"volume", NodeClass::volume},
                                                    {"probe", NodeClass::probe},
                                                    {"occluder", NodeClass::occluder},
                                                    {"ignored", NodeClass::ignored}},
                                                   where));
    LUMEL_TRY(out.texel_density, number_in(json, "texel_density", 1.0 / 64, 64.0, where));
    return out;
}

Result<float> positive(const Json& json, const char* key, const std::string& where) {
    LUMEL_TRY(const std::optional<float> value, number_in(json, key, 1e-6, 1e6, where));
    if (!value) return invalid(where, std::string("'") + key + "' is missing");
    return *value;
}

Status read_size(const Json& json, SidecarAreaLight& out, const std::string& where) {
    if (out.light.shape == LightShape::rectangle) {
        LUMEL_TRY_STATUS(check_keys(json,
                                    {"name", "shape", "nits", "color", "node", "position", "direction", "up", "width",
                                     "height", "bake", "indirect_scale", "indirect_color"},
                                    where));
        LUMEL_TRY(out.width, positive(json, "width", where));
        LUMEL_TRY(out.height, positive(json, "height", where));
        return success();
    }
    LUMEL_TRY_STATUS(check_keys(json,
                                {"name", "shape", "nits", "color", "node", "position", "direction", "up", "radius",
                                 "bake", "indirect_scale", "indirect_color"},
                                where));
    LUMEL_TRY(out.radius, positive(json, "radius", where));
    return success();
}

Status read_placement(const Json& json, SidecarAreaLight& out, const std::string& where) {
    LUMEL_TRY(out.node, string_or(json, "node", "", where));
    LUMEL_TRY(const std::optional<Vec3> position, vector_of(json, "position", where));
    LUMEL_TRY(const std::optional<Vec3> direction, direction_of(json, "direction", where));
    LUMEL_TRY(out.up, direction_of(json, "up", where));
    const bool by_node = find(json, "node") != nullptr;
    if (by_node && (position || direction || out.up))
        return invalid(where, "'node' places the light; it goes with neither 'position', 'direction' nor 'up'");
    if (by_node) return success();
    if (!position) return invalid(where, "needs a 'position' or a 'node'");
    if (!direction && out.light.shape != LightShape::sphere) return invalid(where, "needs a 'direction' or a 'node'");
    out.position = *position;
    out.direction = direction.value_or(out.direction);
    return success();
}

Result<SidecarAreaLight> read_area_light(const Json& json, std::size_t index, const std::string& where) {
    if (!json.is_object()) return invalid(where, "must be an object");
    SidecarAreaLight out;
    LUMEL_TRY(out.light.name, string_or(json, "name", "area light " + std::to_string(index), where));
    LUMEL_TRY(
        const auto shape,
        choice_of<LightShape>(
            json, "shape",
            {{"rectangle", LightShape::rectangle}, {"disc", LightShape::disc}, {"sphere", LightShape::sphere}}, where));
    if (!shape) return invalid(where, "'shape' is missing", "one of: rectangle, disc, sphere");
    out.light.shape = *shape;
    LUMEL_TRY_STATUS(read_size(json, out, where));
    LUMEL_TRY_STATUS(read_placement(json, out, where));
    LUMEL_TRY(const std::optional<float> nits, number_in(json, "nits", 0.0, 1e12, where));
    if (!nits) return invalid(where, "'nits' is missing");
    LUMEL_TRY(const std::optional<Vec3> color, color_of(json, "color", where));
    out.light.intensity = color.value_or(Vec3{1, 1, 1}) * *nits;
    LightSettings controls;
    LUMEL_TRY_STATUS(read_artist_controls(json, controls, where));
    out.light.bake = controls.bake.value_or(LightBake::all);
    out.light.indirect_scale = controls.indirect_scale.value_or(1.0f);
    out.light.indirect_color = controls.indirect_color.value_or(Vec3{1, 1, 1});
    return out;
}

Result<SkySettings> read_sky_settings(const Json& json, const std::string& where) {
    LUMEL_TRY_STATUS(check_keys(json, {"color", "map", "intensity", "rotation_degrees"}, where));
    SkySettings out;
    LUMEL_TRY(const std::optional<Vec3> color, color_of(json, "color", where));
    LUMEL_TRY(out.map, string_or(json, "map", "", where));
    if (color.has_value() == !out.map.empty()) return invalid(where, "needs either a 'color' or a 'map'");
    LUMEL_TRY(const auto intensity, number_in(json, "intensity", 0.0, 1e12, where));
    LUMEL_TRY(const auto rotation, number_in(json, "rotation_degrees", -360.0, 360.0, where));
    out.color = color.value_or(Vec3{});
    out.intensity = intensity.value_or(1.0f);
    out.rotation = static_cast<float>(rotation.value_or(0.0f) * kRadiansPerDegree);
    return out;
}

// Calls read(value, where) for each member of the object `key` and stores the result by its name.
template <class T, class Read>
Status read_members(const Json& root, const char* key, std::map<std::string, T>& out, const std::string& where,
                    Read&& read) {
    LUMEL_TRY(const Json* object, optional_object(root, key, where));
    if (!object) return success();
    for (auto member = object->begin(); member != object->end(); ++member) {
        LUMEL_TRY(T value, read(member.value(), where + ": " + key + " '" + member.key() + "'"));
        out.emplace(member.key(), std::move(value));
    }
    return success();
}

}  // namespace

Result<Sidecar> parse_sidecar(std::string_view text, const std::string& where) {
    LUMEL_TRY(const Json root, parse_json(text, where));
    LUMEL_TRY_STATUS(check_keys(root, {"$schema", "version", "lights", "area_lights", "sky", "nodes"}, where));
    LUMEL_TRY(const std::uint64_t version, count_or(root, "version", 1, where));
    if (version != 1)
        return unsupported(where, "is version " + std::to_string(version) + " of the sidecar",
                           "this Lumel reads version 1");
    Sidecar out;
    out.where = where;
    LUMEL_TRY_STATUS(read_members(root, "lights", out.lights, where, read_light));
    LUMEL_TRY_STATUS(read_members(root, "nodes", out.nodes, where, read_node));
    LUMEL_TRY(const Json* area_lights, optional_array(root, "area_lights", where));
    for (std::size_t i = 0; area_lights && i < area_lights->size(); ++i) {
        LUMEL_TRY(SidecarAreaLight light,
                  read_area_light((*area_lights)[i], i, where + ": area_lights[" + std::to_string(i) + "]"));
        out.area_lights.push_back(std::move(light));
    }
    LUMEL_TRY(const Json* sky, optional_object(root, "sky", where));
    if (sky) {
        LUMEL_TRY(out.sky, read_sky_settings(*sky, where + ": sky"));
    }
    return out;
}

}  // namespace lumel
