// Counts a scene once, then writes it as text or as JSON.
#include "io/info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/node_class.h"

namespace lumel {
namespace {

using Json = nlohmann::ordered_json;

// ---- Counting -------------------------------------------------------------------------------------------------------

struct Emitter {
    double area = 0.0;  // square metres, all instances
    std::uint64_t triangles = 0;
};

struct Summary {
    std::uint64_t instances = 0, triangles = 0, texels = 0;
    std::array<std::uint64_t, 5> classes{};  // by NodeClass
    std::size_t with_uv0 = 0, with_uv1 = 0, with_colors = 0;
    // Of the meshes with TEXCOORD_1: kept, as one atlas of the scene or packed anew; rejected; of no lightmap instance.
    std::size_t uv1_kept = 0, uv1_rejected = 0, uv1_unused = 0;
    bool uv1_is_atlas = false;
    std::vector<Emitter> emitters;  // per material
    Vec3 low{}, high{};
};

void count_meshes(const Scene& scene, Summary& out) {
    for (const auto& mesh : scene.meshes) {
        out.with_uv0 += !mesh->uv0.empty();
        out.with_uv1 += !mesh->uv1.empty();
        out.with_colors += !mesh->colors.empty();
    }
}

void count_uv1(const Scene& scene, const ChartSet& uv1, Summary& out) {
    std::vector<bool> used(scene.meshes.size());
    for (const Instance& instance : scene.instances)
        if (instance.node_class == NodeClass::lightmap) used[instance.mesh] = true;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        if (scene.meshes[m]->uv1.empty()) continue;
        ++(!used[m] ? out.uv1_unused : uv1.meshes[m].from_uv1 ? out.uv1_kept : out.uv1_rejected);
    }
    out.uv1_is_atlas = uv1.scene_wide;
}

double triangle_area(const Affine& m, const Mesh& mesh, const Triangle& t) {
    const Vec3 a = transform_point(m, mesh.positions[t[0]]);
    const Vec3 b = transform_point(m, mesh.positions[t[1]]);
    const Vec3 c = transform_point(m, mesh.positions[t[2]]);
    return 0.5 * double{length(cross(b - a, c - a))};
}

void count_emission(const Scene& scene, const Instance& instance, const Mesh& mesh, Summary& out) {
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.material == kNone || max_component(scene.materials[primitive.material].emission) <= 0.0f)
            continue;
        Emitter& emitter = out.emitters[primitive.material];
        emitter.triangles += primitive.triangle_count;
        for (std::uint32_t t = 0; t < primitive.triangle_count; ++t)
            emitter.area += triangle_area(instance.transform, mesh, mesh.triangles[primitive.first_triangle + t]);
    }
}

Summary summarize(const Scene& scene, const ChartSet& uv1) {
    Summary out;
    out.emitters.resize(scene.materials.size());
    for (const Texture& texture : scene.textures) out.texels += std::uint64_t{texture.width} * texture.height;
    count_meshes(scene, out);
    count_uv1(scene, uv1, out);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = *scene.meshes[instance.mesh];
        for (const Vec3& p : mesh.positions) {
            const Vec3 world = transform_point(instance.transform, p);
            out.low = out.instances == 0 && &p == &mesh.positions[0] ? world : min(out.low, world);
            out.high = out.instances == 0 && &p == &mesh.positions[0] ? world : max(out.high, world);
        }
        ++out.instances;
        ++out.classes[static_cast<std::size_t>(instance.node_class)];
        out.triangles += mesh.triangles.size();
        count_emission(scene, instance, mesh, out);
    }
    return out;
}

// ---- Words ----------------------------------------------------------------------------------------------------------

const char* shape_name(LightShape shape) {
    switch (shape) {
        case LightShape::sun: return "sun";
        case LightShape::point: return "point";
        case LightShape::spot: return "spot";
        case LightShape::rectangle: return "rectangle";
        case LightShape::disc: return "disc";
        case LightShape::sphere: return "sphere";
    }
    return "";
}

const char* unit_of(LightShape shape) {
    switch (shape) {
        case LightShape::sun: return "lux";
        case LightShape::point:
        case LightShape::spot: return "candela";
        default: return "nits";
    }
}

double degrees(float radians) { return double{radians} * 57.29577951308232; }

std::string number(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.5g", value);
    return buffer;
}

std::string triple(Vec3 v) {
    char buffer[96];
    std::snprintf(buffer, sizeof buffer, "(%.5g, %.5g, %.5g)", double{v.x}, double{v.y}, double{v.z});
    return buffer;
}

Json json_of(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

std::string uv1_state(const Scene& scene, const Summary& summary) {
    if (summary.with_uv1 == 0) return "none: charts will be made";
    std::string out =
        number(static_cast<double>(summary.with_uv1)) + " of " + std::to_string(scene.meshes.size()) + " meshes";
    if (summary.uv1_is_atlas) return out + ": kept as one atlas of the scene";
    std::string uses;
    const auto add = [&](std::size_t count, const char* use) {
        if (count > 0) uses += (uses.empty() ? "" : ", ") + std::to_string(count) + " " + use;
    };
    add(summary.uv1_kept, "keep their charts, packed anew (why: uv1-repacked below)");
    add(summary.uv1_rejected, "rejected, charts will be made (why: uv1-rejected below)");
    add(summary.uv1_unused, "not lightmapped");
    return out + ": " + uses;
}

// ---- Text -----------------------------------------------------------------------------------------------------------

void line(std::string& out, const char* what, const std::string& value) {
    char head[16];
    std::snprintf(head, sizeof head, "%-11s", what);
    out += head + value + "\n";
}

std::string classes_text(const Summary& summary) {
    std::string out;
    for (std::size_t i = 0; i < summary.classes.size(); ++i) {
        if (summary.classes[i] == 0) continue;
        out += (out.empty() ? "" : ", ") + std::to_string(summary.classes[i]) + " " +
               class_name(static_cast<NodeClass>(i));
    }
    return out;
}

std::string light_text(const Light& light) {
    std::string out = std::string(shape_name(light.shape)) + " '" + light.name + "' " + triple(light.intensity) + " " +
                      unit_of(light.shape);
    if (light.shape == LightShape::sun) {
        out += ", travels along " + triple(light.direction) + ", angle " + number(degrees(light.angular_diameter)) +
               " degrees";
    } else {
        out += " at " + triple(light.position);
    }
    if (light.shape == LightShape::spot)
        out += ", cone " + number(degrees(light.inner_cone)) + " to " + number(degrees(light.outer_cone)) + " degrees";
    if (light.radius > 0.0f) out += ", radius " + number(double{light.radius}) + " m";
    if (light.range > 0.0f) out += ", range " + number(double{light.range}) + " m";
    if (light.bake == LightBake::indirect) out += ", indirect light only";
    if (light.bake == LightBake::none) out += ", not baked";
    return out;
}

std::string sky_text(const Sky& sky) {
    if (sky.map)
        return "map of " + std::to_string(sky.map->width) + " x " + std::to_string(sky.map->height) + " pixels";
    return sky.is_black() ? "none" : "colour " + triple(sky.color) + " nits";
}

std::string materials_text(const Scene& scene) {
    std::size_t mask = 0, blend = 0, two_sided = 0;
    for (const Material& material : scene.materials) {
        mask += material.alpha_mode == AlphaMode::mask;
        blend += material.alpha_mode == AlphaMode::blend;
        two_sided += material.double_sided;
    }
    // The default material at the end is not the file's.
    return std::to_string(scene.materials.size() - 1) + ": " + std::to_string(mask) + " mask, " +
           std::to_string(blend) + " blend, " + std::to_string(two_sided) + " double-sided";
}

bool has_emitters(const Summary& summary) {
    return std::any_of(summary.emitters.begin(), summary.emitters.end(),
                       [](const Emitter& e) { return e.triangles > 0; });
}

void emitters_text(const Scene& scene, const Summary& summary, std::string& out) {
    for (std::size_t i = 0; i < summary.emitters.size(); ++i) {
        if (summary.emitters[i].triangles == 0) continue;
        const Material& material = scene.materials[i];
        line(out, "emitter",
             "'" + material.name + "' " + triple(material.emission) + " nits" +
                 (material.emission_texture.texture == kNone ? "" : " times its texture") + " on " +
                 number(summary.emitters[i].area) + " m2");
    }
}

void warnings_text(const Diagnostics& diagnostics, std::string& out) {
    for (const Diagnostic& item : diagnostics.all()) {
        line(out, "note", item.message + " [" + item.code + ", " + std::to_string(item.count) + "]");
        for (const std::string& example : item.examples) line(out, "", "  " + example);
    }
}

// ---- JSON -----------------------------------------------------------------------------------------------------------

Json light_json(const Light& light) {
    Json out{{"name", light.name},
             {"shape", shape_name(light.shape)},
             {"intensity", json_of(light.intensity)},
             {"unit", unit_of(light.shape)}};
    if (light.shape != LightShape::sun) out["position"] = json_of(light.position);
    if (light.shape != LightShape::point && light.shape != LightShape::sphere)
        out["direction"] = json_of(light.direction);
    if (light.shape == LightShape::sun) out["angle_degrees"] = degrees(light.angular_diameter);
    if (light.shape == LightShape::spot) out["cone_degrees"] = {degrees(light.inner_cone), degrees(light.outer_cone)};
    if (light.shape == LightShape::rectangle || light.shape == LightShape::disc) {
        out["half_u"] = json_of(light.half_u);
        out["half_v"] = json_of(light.half_v);
    }
    if (light.radius > 0.0f) out["radius"] = light.radius;
    if (light.range > 0.0f) out["range"] = light.range;
    static constexpr const char* kBake[] = {"all", "indirect", "none"};
    out["bake"] = kBake[static_cast<std::size_t>(light.bake)];
    return out;
}

Json emitters_json(const Scene& scene, const Summary& summary) {
    Json out = Json::array();
    for (std::size_t i = 0; i < summary.emitters.size(); ++i) {
        if (summary.emitters[i].triangles == 0) continue;
        const Material& material = scene.materials[i];
        out.push_back({{"material", material.name},
                       {"radiance", json_of(material.emission)},
                       {"unit", "nits"},
                       {"textured", material.emission_texture.texture != kNone},
                       {"area", summary.emitters[i].area},
                       {"triangles", summary.emitters[i].triangles}});
    }
    return out;
}

Json cameras_json(const Scene& scene) {
    Json out = Json::array();
    for (const Camera& camera : scene.cameras)
        out.push_back({{"name", camera.name},
                       {"position", json_of(camera.transform.translation)},
                       {"vertical_fov_degrees", degrees(camera.vertical_fov)}});
    return out;
}

Json notes_json(const Diagnostics& diagnostics) {
    Json out = Json::array();
    for (const Diagnostic& item : diagnostics.all())
        out.push_back(
            {{"code", item.code}, {"message", item.message}, {"count", item.count}, {"examples", item.examples}});
    return out;
}

Json classes_json(const Summary& summary) {
    Json out = Json::object();
    for (std::size_t i = 0; i < summary.classes.size(); ++i)
        out[class_name(static_cast<NodeClass>(i))] = summary.classes[i];
    return out;
}

Json sky_json(const Sky& sky) {
    if (sky.map) return {{"map", {sky.map->width, sky.map->height}}, {"rotation_degrees", degrees(sky.rotation)}};
    return {{"color", json_of(sky.color)}, {"unit", "nits"}};
}

Json uv1_json(const Summary& summary) {
    return {{"one_atlas", summary.uv1_is_atlas},
            {"kept", summary.uv1_kept},
            {"rejected", summary.uv1_rejected},
            {"not_lightmapped", summary.uv1_unused}};
}

}  // namespace

std::string describe(const Scene& scene, const ChartSet& uv1, const Diagnostics& diagnostics) {
    const Summary summary = summarize(scene, uv1);
    std::string out;
    line(out, "scene", scene.source);
    line(out, "geometry",
         std::to_string(scene.meshes.size()) + " meshes, " + std::to_string(summary.instances) + " instances, " +
             std::to_string(summary.triangles) + " triangles");
    line(out, "bounds", triple(summary.low) + " to " + triple(summary.high) + " m");
    line(out, "classes", classes_text(summary));
    line(out, "materials", materials_text(scene));
    line(
        out, "textures",
        std::to_string(scene.textures.size()) + ": " + number(static_cast<double>(summary.texels) * 1e-6) + " Mtexels");
    line(out, "UV 0", std::to_string(summary.with_uv0) + " of " + std::to_string(scene.meshes.size()) + " meshes");
    line(out, "UV 1", uv1_state(scene, summary));
    line(out, "sky", sky_text(scene.sky));
    if (scene.lights.empty()) line(out, "light", "none");
    for (const Light& light : scene.lights) line(out, "light", light_text(light));
    emitters_text(scene, summary, out);
    if (scene.lights.empty() && scene.sky.is_black() && !has_emitters(summary))
        line(out, "note", "nothing emits light: a bake needs --sky or --sun-direction");
    for (const Camera& camera : scene.cameras)
        line(out, "camera",
             "'" + camera.name + "' at " + triple(camera.transform.translation) + ", " +
                 number(degrees(camera.vertical_fov)) + " degrees");
    warnings_text(diagnostics, out);
    return out;
}

std::string describe_json(const Scene& scene, const ChartSet& uv1, const Diagnostics& diagnostics) {
    const Summary summary = summarize(scene, uv1);
    Json lights = Json::array();
    for (const Light& light : scene.lights) lights.push_back(light_json(light));
    const Json out{{"scene", scene.source},
                   {"meshes", scene.meshes.size()},
                   {"instances", summary.instances},
                   {"triangles", summary.triangles},
                   {"bounds", {{"min", json_of(summary.low)}, {"max", json_of(summary.high)}}},
                   {"classes", classes_json(summary)},
                   {"materials", scene.materials.size() - 1},
                   {"textures", {{"count", scene.textures.size()}, {"texels", summary.texels}}},
                   {"uv0_meshes", summary.with_uv0},
                   {"uv1_meshes", summary.with_uv1},
                   {"uv1", uv1_json(summary)},
                   {"vertex_color_meshes", summary.with_colors},
                   {"sky", sky_json(scene.sky)},
                   {"lights", std::move(lights)},
                   {"emitters", emitters_json(scene, summary)},
                   {"cameras", cameras_json(scene)},
                   {"notes", notes_json(diagnostics)}};
    // Names may hold bytes that are not UTF-8 where a scene came through the API; they are replaced, not thrown at.
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lumel
