// Scenes made in code, for tests: one mesh of quads and boxes with flat normals, optional TEXCOORD_1, lights.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "lumel/scene.h"

namespace lumel::test {

class SceneBuilder {
public:
    SceneBuilder() { scene_.source = "test scene"; }

    // Returns the material's index.
    std::uint32_t material(Vec3 albedo, Vec3 emission = {}, bool double_sided = false) {
        Material m;
        m.name = "material " + std::to_string(scene_.materials.size());
        m.base_color = albedo;
        m.emission = emission;
        m.double_sided = double_sided;
        scene_.materials.push_back(m);
        return static_cast<std::uint32_t>(scene_.materials.size()) - 1;
    }
    std::uint32_t texture(Texture texture) {
        scene_.textures.push_back(std::move(texture));
        return static_cast<std::uint32_t>(scene_.textures.size()) - 1;
    }
    Material& material_at(std::uint32_t index) { return scene_.materials[index]; }

    // A mesh and an instance of it; `fill` adds to the mesh by the functions below.
    template <class Fill>
    std::uint32_t object(const std::string& name, std::uint32_t material, Fill&& fill, const Affine& transform = {},
                         NodeClass node_class = NodeClass::lightmap) {
        auto mesh = std::make_shared<Mesh>();
        mesh->name = name;
        fill(*mesh);
        mesh->primitives.push_back({0, static_cast<std::uint32_t>(mesh->positions.size()), 0,
                                    static_cast<std::uint32_t>(mesh->triangles.size()), material});
        scene_.meshes.push_back(mesh);
        return instance(name, static_cast<std::uint32_t>(scene_.meshes.size()) - 1, transform, node_class);
    }
    std::uint32_t instance(const std::string& name, std::uint32_t mesh, const Affine& transform,
                           NodeClass node_class = NodeClass::lightmap) {
        scene_.instances.push_back({name, mesh, transform, node_class, 1.0f});
        return static_cast<std::uint32_t>(scene_.instances.size()) - 1;
    }
    Light& light(LightShape shape) {
        scene_.lights.emplace_back();
        scene_.lights.back().shape = shape;
        scene_.lights.back().name = "light " + std::to_string(scene_.lights.size() - 1);
        return scene_.lights.back();
    }
    Scene& scene() { return scene_; }

    // Appends glTF's default material and the display side, and hands the scene over.
    Scene build() {
        scene_.materials.emplace_back();
        scene_.display.meshes = scene_.meshes;
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i)
            scene_.display.instances.push_back({{}, scene_.instances[i].mesh, i});
        return std::move(scene_);
    }

private:
    Scene scene_;
};

// origin + s*u + t*v; front u x v; UV0 over [0, 1] x [0, 1].
inline void add_quad(Mesh& mesh, Vec3 origin, Vec3 u, Vec3 v) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3 normal = normalize(cross(u, v));
    for (const auto& [s, t] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
        mesh.positions.push_back(origin + u * s + v * t);
        mesh.normals.push_back(normal);
        mesh.uv0.push_back({s, t});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

inline void add_box(Mesh& mesh, Vec3 low, Vec3 high, bool inward) {
    const Vec3 d = high - low;
    const Vec3 x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    const auto face = [&](Vec3 origin, Vec3 u, Vec3 v) {
        inward ? add_quad(mesh, origin, v, u) : add_quad(mesh, origin, u, v);
    };
    face(low, y, x);
    face(low + z, x, y);
    face(low, z, y);
    face(low + x, y, z);
    face(low, x, z);
    face(low + y, z, x);
}

}  // namespace lumel::test
