// The name of a scene's content. Names, cameras and where the scene is displayed change no lightmap and stay out.
#include "base/hash.h"
#include "scene/world_geometry.h"

namespace lumel {
namespace {

template <class T>
void add_floats(Hasher& hash, const T& value) {
    static_assert(sizeof(T) % sizeof(float) == 0 && alignof(T) == alignof(float));
    hash.bytes(std::as_bytes(std::span(&value, 1)));
}

void add(Hasher& hash, const Texture& texture) {
    hash.pod(texture.width).pod(texture.height).pod(std::uint8_t{texture.srgb});
    hash.array(std::span<const std::uint8_t>(texture.rgba));
}

void add(Hasher& hash, const TextureRef& ref) {
    hash.pod(ref.texture);
    if (ref.texture == kNone) return;
    hash.pod(ref.uv_set).pod(ref.wrap_u).pod(ref.wrap_v).pod(std::uint8_t{ref.nearest});
    add_floats(hash, ref.transform);
}

void add(Hasher& hash, const Material& material) {
    add_floats(hash, material.base_color);
    hash.pod(material.alpha);
    add(hash, material.base_color_texture);
    add_floats(hash, material.emission);
    add(hash, material.emission_texture);
    hash.pod(material.alpha_mode).pod(material.alpha_cutoff).pod(std::uint8_t{material.double_sided});
}

void add(Hasher& hash, const Mesh& mesh) {
    hash.array(std::span<const Vec3>(mesh.positions)).array(std::span<const Vec3>(mesh.normals));
    hash.array(std::span<const Vec2>(mesh.uv0)).array(std::span<const Vec2>(mesh.uv1));
    hash.array(std::span<const Vec4>(mesh.colors)).array(std::span<const Triangle>(mesh.triangles));
    hash.array(std::span<const Primitive>(mesh.primitives));
}

void add(Hasher& hash, const Instance& instance) {
    hash.pod(instance.mesh)
        .pod(instance.node_class)
        .pod(instance.density_scale)
        .pod(std::uint8_t{instance.class_is_asked});
    add_floats(hash, instance.transform);
}

void add(Hasher& hash, const Light& light) {
    hash.pod(light.shape).pod(light.bake);
    for (const Vec3& v :
         {light.intensity, light.position, light.direction, light.half_u, light.half_v, light.indirect_color})
        add_floats(hash, v);
    for (const float f :
         {light.radius, light.range, light.inner_cone, light.outer_cone, light.angular_diameter, light.indirect_scale})
        hash.pod(f);
}

void add(Hasher& hash, const Sky& sky) {
    add_floats(hash, sky.color);
    hash.pod(sky.rotation).pod(std::uint8_t{sky.map.has_value()});
    if (!sky.map) return;
    hash.pod(sky.map->width).pod(sky.map->height).array(std::span<const Vec3>(sky.map->radiance));
}

}  // namespace

Hash128 hash_scene(const Scene& scene) {
    Hasher hash;
    hash.text("lumel scene 1");
    const auto all = [&](const auto& items) {
        hash.pod(static_cast<std::uint64_t>(items.size()));
        for (const auto& item : items) add(hash, item);
    };
    all(scene.textures);
    all(scene.materials);
    hash.pod(static_cast<std::uint64_t>(scene.meshes.size()));
    for (const auto& mesh : scene.meshes) add(hash, *mesh);
    all(scene.instances);
    all(scene.lights);
    add(hash, scene.sky);
    return hash.finish();
}

}  // namespace lumel
