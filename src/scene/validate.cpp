// The gate that every scene passes before a stage sees it. Later stages index without asking again.
#include <cmath>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include "base/try.h"
#include "math/constants.h"
#include "scene/world_geometry.h"

namespace lumel {
namespace {

Error bad(std::string where, std::string message, std::string remedy = {}) {
    return {ErrorCode::invalid_input, std::move(message), std::move(where), std::move(remedy)};
}

std::string item(const char* kind, std::size_t index, const std::string& name) {
    std::string out = std::string(kind) + " " + std::to_string(index);
    return name.empty() ? out : out + " '" + name + "'";
}

std::string brief(float x) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << x;
    return out.str();
}

bool finite(float x) { return std::isfinite(x); }
bool not_negative(Vec3 v) { return is_finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f; }
// Of light; the actual product of all that scales it. Error: `where`, what is too bright and what to lower.
Status check_bright(Vec3 light, std::string_view where, const char* what, const char* remedy) {
    if (!not_negative(light))
        return bad(std::string(where), std::string(what) + " must be finite and not negative", remedy);
    if (max_component(light) > kMaxRadiance)
        return bad(std::string(where),
                   std::string(what) + " is " + brief(max_component(light)) + ", above the limit of 1e12", remedy);
    return success();
}
// Loose enough for normals stored in 8 bits, tight enough that nobody needs to normalise again.
bool unit(Vec3 v) { return std::fabs(dot(v, v) - 1.0f) < 1e-3f; }
bool finite(const Affine& m) {
    return is_finite(m.columns[0]) && is_finite(m.columns[1]) && is_finite(m.columns[2]) && is_finite(m.translation);
}

Status check_texture(const Texture& texture, const std::string& where) {
    if (texture.width == 0 || texture.height == 0) return bad(where, "has no pixels");
    if (texture.rgba.size() != std::size_t{texture.width} * texture.height * 4)
        return bad(where, "holds " + std::to_string(texture.rgba.size()) + " bytes, which is not width * height * 4");
    return success();
}

Status check_texture_ref(const Scene& scene, const TextureRef& ref, const std::string& where) {
    if (ref.texture == kNone) return success();
    if (ref.texture >= scene.textures.size())
        return bad(where, "texture index " + std::to_string(ref.texture) + " is out of range");
    if (ref.uv_set > 1) return bad(where, "UV set must be 0 or 1");
    for (const float m : ref.transform)
        if (!finite(m)) return bad(where, "the texture transform is not finite");
    return success();
}

Status check_material(const Scene& scene, const Material& material, const std::string& where) {
    if (!not_negative(material.base_color) || max_component(material.base_color) > 1.0f)
        return bad(where, "base colour must lie in [0, 1]");
    if (!(material.alpha >= 0.0f && material.alpha <= 1.0f)) return bad(where, "alpha must lie in [0, 1]");
    LUMEL_TRY_STATUS(check_bright(material.emission, where, "emission", "lower emissiveFactor or emissiveStrength"));
    if (!(material.alpha_cutoff >= 0.0f && finite(material.alpha_cutoff)))
        return bad(where, "alpha cutoff must not be negative");
    LUMEL_TRY_STATUS(check_texture_ref(scene, material.base_color_texture, where));
    return check_texture_ref(scene, material.emission_texture, where);
}

Status check_vertices(const Mesh& mesh, const std::string& where) {
    const std::size_t count = mesh.positions.size();
    if (count >= kNone) return bad(where, "has more than 2^32 vertices");
    if (mesh.normals.size() != count) return bad(where, "needs one normal per vertex");
    for (const std::size_t size : {mesh.uv0.size(), mesh.uv1.size(), mesh.colors.size()})
        if (size != 0 && size != count)
            return bad(where, "an attribute has another number of elements than the positions");
    const auto vertex = [&](std::size_t v) { return where + " vertex " + std::to_string(v); };
    for (std::size_t v = 0; v < count; ++v) {
        if (!is_finite(mesh.positions[v])) return bad(vertex(v), "the position is not finite");
        if (!unit(mesh.normals[v])) return bad(vertex(v), "the normal is not of unit length");
        if (!mesh.uv0.empty() && !is_finite(mesh.uv0[v])) return bad(vertex(v), "UV 0 is not finite");
        if (!mesh.uv1.empty() && !is_finite(mesh.uv1[v])) return bad(vertex(v), "UV 1 is not finite");
        if (mesh.colors.empty()) continue;
        const Vec4 c = mesh.colors[v];
        if (!not_negative({c.x, c.y, c.z}) || !(c.w >= 0.0f && finite(c.w)))
            return bad(vertex(v), "the colour must be finite and not negative");
    }
    return success();
}

Status check_primitive(const Scene& scene, const Mesh& mesh, const Primitive& primitive, const std::string& where) {
    if (primitive.material != kNone && primitive.material >= scene.materials.size())
        return bad(where, "material index " + std::to_string(primitive.material) + " is out of range");
    const std::uint32_t last = primitive.first_vertex + primitive.vertex_count;
    for (std::uint32_t t = 0; t < primitive.triangle_count; ++t)
        for (const std::uint32_t v : mesh.triangles[primitive.first_triangle + t])
            if (v < primitive.first_vertex || v >= last)
                return bad(where + " triangle " + std::to_string(t),
                           "index " + std::to_string(v - primitive.first_vertex) +
                               " is out of range: the primitive has " + std::to_string(primitive.vertex_count) +
                               " vertices");
    return success();
}

Status check_mesh(const Scene& scene, const Mesh& mesh, const std::string& where) {
    LUMEL_TRY_STATUS(check_vertices(mesh, where));
    std::uint64_t vertices = 0, triangles = 0;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const Primitive& primitive = mesh.primitives[i];
        const std::string name = where + " primitive " + std::to_string(i);
        if (primitive.first_vertex != vertices || primitive.first_triangle != triangles)
            return bad(name, "primitives must follow each other without gaps");
        vertices += primitive.vertex_count;
        triangles += primitive.triangle_count;
        if (vertices > mesh.positions.size() || triangles > mesh.triangles.size())
            return bad(name, "reaches beyond the mesh");
        LUMEL_TRY_STATUS(check_primitive(scene, mesh, primitive, name));
    }
    if (vertices != mesh.positions.size() || triangles != mesh.triangles.size())
        return bad(where, "has vertices or triangles outside its primitives");
    return success();
}

Status check_instance(const Scene& scene, const Instance& instance, const std::string& where) {
    if (instance.mesh >= scene.meshes.size()) return bad(where, "mesh index is out of range");
    if (!finite(instance.transform)) return bad(where, "the transform is not finite");
    if (!(instance.density_scale > 0.0f && finite(instance.density_scale)))
        return bad(where, "the density scale must be positive");
    return success();
}

Status check_display(const Scene& scene) {
    for (const auto& mesh : scene.display.meshes)
        if (!mesh) return bad("display", "a mesh is missing");
    for (std::size_t i = 0; i < scene.display.instances.size(); ++i) {
        const DisplayInstance& instance = scene.display.instances[i];
        const std::string where = item("display instance", i, {});
        if (instance.mesh >= scene.display.meshes.size()) return bad(where, "mesh index is out of range");
        if (instance.baked_instance != kNone && instance.baked_instance >= scene.instances.size())
            return bad(where, "baked instance is out of range");
    }
    return success();
}

Status check_area_light(const Light& light, const std::string& where) {
    const Vec3 normal = cross(light.half_u, light.half_v);
    const float area = length(normal);
    if (!(area > 0.0f && finite(area))) return bad(where, "the light has no area", "give it a size above zero");
    // 0.999: a shear of 2.5 degrees, far above rounding.
    if (dot(normal, light.direction) < 0.999f * area)
        return bad(where, "half_u x half_v must point along the light's direction");
    return success();
}

Status check_light(const Light& light, const std::string& where) {
    constexpr const char* kRemedy = "lower the light's intensity, nits or illuminance";
    LUMEL_TRY_STATUS(check_bright(light.intensity, where, "intensity", kRemedy));
    if (!is_finite(light.position)) return bad(where, "position is not finite");
    if (!unit(light.direction)) return bad(where, "direction is not of unit length");
    for (const float f : {light.radius, light.range, light.angular_diameter, light.indirect_scale})
        if (!(f >= 0.0f && finite(f)))
            return bad(where, "radius, range, angle and scale must be finite and not negative");
    if (!not_negative(light.indirect_color)) return bad(where, "indirect colour must be finite and not negative");
    LUMEL_TRY_STATUS(check_bright(light.intensity * light.indirect_color * light.indirect_scale, where,
                                  "intensity times indirect scale and colour", "lower one of them"));
    if (light.angular_diameter > kPi) return bad(where, "a sun's angular diameter is at most 180 degrees");
    if (light.shape == LightShape::spot &&
        !(light.inner_cone >= 0.0f && light.inner_cone <= light.outer_cone && light.outer_cone <= 0.5f * kPi + 1e-6f))
        return bad(where, "cone angles must satisfy 0 <= inner <= outer <= 90 degrees");
    if (light.shape == LightShape::rectangle || light.shape == LightShape::disc) return check_area_light(light, where);
    if (light.shape == LightShape::sphere && !(light.radius > 0.0f))
        return bad(where, "a sphere light needs a radius", "or make it a point light with an intensity in candela");
    return success();
}

Status check_sky(const Sky& sky) {
    constexpr const char* kRemedy = "lower --sky-intensity, or the intensity or colour in the sidecar";
    LUMEL_TRY_STATUS(check_bright(sky.color, "sky", "colour times intensity", kRemedy));
    if (!finite(sky.rotation)) return bad("sky", "rotation is not finite");
    if (!sky.map) return success();
    if (sky.map->width == 0 || sky.map->height == 0 ||
        sky.map->radiance.size() != std::size_t{sky.map->width} * sky.map->height)
        return bad("sky map", "holds another number of pixels than width * height");
    for (const Vec3& pixel : sky.map->radiance)
        LUMEL_TRY_STATUS(check_bright(pixel, "sky map", "the brightest of its pixels, times intensity,", kRemedy));
    return success();
}

Status check_camera(const Camera& camera, const std::string& where) {
    if (!finite(camera.transform)) return bad(where, "the transform is not finite");
    if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < kPi))
        return bad(where, "field of view must lie between 0 and 180 degrees");
    if (!(camera.aspect >= 0.0f && finite(camera.aspect))) return bad(where, "aspect must be finite and not negative");
    return success();
}

template <class T, class Check>
Status check_all(const std::vector<T>& items, const char* kind, Check&& check) {
    for (std::size_t i = 0; i < items.size(); ++i) LUMEL_TRY_STATUS(check(items[i], item(kind, i, items[i].name)));
    return success();
}

Status check_meshes(const Scene& scene) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (!scene.meshes[i]) return bad(item("mesh", i, {}), "is missing");
        LUMEL_TRY_STATUS(check_mesh(scene, *scene.meshes[i], item("mesh", i, scene.meshes[i]->name)));
    }
    return success();
}

Status check_has_triangles(const Scene& scene) {
    for (const Instance& instance : scene.instances)
        if (!scene.meshes[instance.mesh]->triangles.empty()) return success();
    return bad({}, "the scene has no triangles",
               "give a scene with at least one mesh of triangles in its default scene");
}

Status check_lighting(const Scene& scene) {
    LUMEL_TRY_STATUS(check_all(scene.lights, "light", check_light));
    return check_sky(scene.sky);
}

Status check_scene(const Scene& scene) {
    if (scene.materials.empty()) return bad("materials", "the last material must be glTF's default; there is none");
    LUMEL_TRY_STATUS(check_all(scene.textures, "texture", check_texture));
    LUMEL_TRY_STATUS(check_all(scene.materials, "material", [&](const Material& material, const std::string& where) {
        return check_material(scene, material, where);
    }));
    LUMEL_TRY_STATUS(check_meshes(scene));
    LUMEL_TRY_STATUS(check_all(scene.instances, "node", [&](const Instance& instance, const std::string& where) {
        return check_instance(scene, instance, where);
    }));
    LUMEL_TRY_STATUS(check_display(scene));
    LUMEL_TRY_STATUS(check_lighting(scene));
    LUMEL_TRY_STATUS(check_all(scene.cameras, "camera", check_camera));
    return check_has_triangles(scene);
}

Status with_source(const Scene& scene, Status status) {
    if (status.ok() || scene.source.empty()) return status;
    Error error = std::move(status).error();
    error.where = error.where.empty() ? scene.source : scene.source + ": " + error.where;
    return error;
}

}  // namespace

Status validate(const Scene& scene) { return with_source(scene, check_scene(scene)); }
Status validate_lighting(const Scene& scene) { return with_source(scene, check_lighting(scene)); }

}  // namespace lumel
