// Small scenes built in code, flattened the way the product does it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "lumel/context.h"
#include "lumel/scene.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"
#include "support/statistics.h"

namespace lumel::test {

struct World {
    Scene scene;
    WorldGeometry geometry;
    [[nodiscard]] SurfaceReader surfaces() const { return {scene, geometry}; }
};

// Each add_ call makes one mesh and one instance of it, with world positions and no transform.
class WorldBuilder {
public:
    std::uint32_t add_texture(Texture texture) {
        scene_.textures.push_back(std::move(texture));
        return static_cast<std::uint32_t>(scene_.textures.size() - 1);
    }
    std::uint32_t add_material(Material material) {
        scene_.materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(scene_.materials.size() - 1);
    }

    // Normals are those of the faces (summed over shared vertices) where `mesh` has none.
    void add_mesh(Mesh mesh, std::uint32_t material = kNone, const Affine& transform = {}) {
        if (mesh.normals.empty()) mesh.normals = face_normals(mesh);
        if (mesh.primitives.empty())
            mesh.primitives = {{0, static_cast<std::uint32_t>(mesh.positions.size()), 0,
                                static_cast<std::uint32_t>(mesh.triangles.size()), material}};
        Instance instance;
        instance.mesh = static_cast<std::uint32_t>(scene_.meshes.size());
        instance.name = "node " + std::to_string(instance.mesh);
        instance.transform = transform;
        scene_.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
        scene_.instances.push_back(instance);
    }

    // The parallelogram corner + s u + t v; faces along u x v. UV set 0 is (s, t).
    void add_quad(Vec3 corner, Vec3 u, Vec3 v, std::uint32_t material = kNone) {
        Mesh mesh;
        mesh.positions = {corner, corner + u, corner + u + v, corner + v};
        mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        add_mesh(std::move(mesh), material);
    }

    // Six quads that share no vertices; faces look out, or in for a room.
    void add_box(Vec3 low, Vec3 high, bool inward = false, std::uint32_t material = kNone) {
        const Vec3 size = high - low, x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
        const std::array<std::array<Vec3, 3>, 6> faces{
            {{low, y, x}, {low + z, x, y}, {low, z, y}, {low + x, y, z}, {low, x, z}, {low + y, z, x}}};
        for (const auto& [corner, u, v] : faces) {
            if (inward) {
                add_quad(corner, v, u, material);
            } else {
                add_quad(corner, u, v, material);
            }
        }
    }

    // A smooth-shaded sphere of 20 * 4^subdivisions triangles with shared vertices.
    void add_icosphere(Vec3 center, float radius, int subdivisions, std::uint32_t material = kNone) {
        Mesh mesh = icosahedron();
        for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh);
        mesh.normals = mesh.positions;
        for (Vec3& p : mesh.positions) p = center + p * radius;
        add_mesh(std::move(mesh), material);
    }

    // Unconnected triangles with corners uniform in a cube.
    void add_soup(std::uint32_t triangles, Vec3 center, float half_edge, std::uint64_t seed,
                  std::uint32_t material = kNone) {
        Random random(seed);
        const auto coordinate = [&] { return half_edge * (2.0f * random.unit() - 1.0f); };
        Mesh mesh;
        for (std::uint32_t t = 0; t < triangles; ++t) {
            for (int corner = 0; corner < 3; ++corner) {
                const float x = coordinate(), y = coordinate(), z = coordinate();
                mesh.positions.push_back(center + Vec3{x, y, z});
            }
            mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        }
        add_mesh(std::move(mesh), material);
    }

    [[nodiscard]] Scene& scene() { return scene_; }

    World build() {
        World world{std::move(scene_), {}};
        world.scene.materials.emplace_back();  // glTF's default material
        Context context(1);
        auto geometry = flatten(world.scene, context);
        if (geometry.ok()) {
            world.geometry = std::move(geometry).value();
        } else {
            ADD_FAILURE() << geometry.error().text();
        }
        return world;
    }

private:
    static std::vector<Vec3> face_normals(const Mesh& mesh) {
        std::vector<Vec3> normals(mesh.positions.size());
        for (const Triangle& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]];
            const Vec3 area = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
            for (const std::uint32_t v : t) normals[v] += area;
        }
        for (Vec3& n : normals) n = normalize_or(n, {0, 1, 0});
        return normals;
    }

    static Mesh icosahedron() {
        const float p = 0.5f * (1.0f + std::sqrt(5.0f));
        Mesh mesh;
        mesh.positions = {{-1, p, 0},  {1, p, 0},  {-1, -p, 0}, {1, -p, 0}, {0, -1, p},  {0, 1, p},
                          {0, -1, -p}, {0, 1, -p}, {p, 0, -1},  {p, 0, 1},  {-p, 0, -1}, {-p, 0, 1}};
        for (Vec3& v : mesh.positions) v = normalize(v);
        mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
        return mesh;
    }

    static Mesh subdivided(const Mesh& coarse) {
        Mesh fine;
        fine.positions = coarse.positions;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, fresh] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size()));
            if (fresh) fine.positions.push_back(normalize(fine.positions[a] + fine.positions[b]));
            return found->second;
        };
        for (const auto& [a, b, c] : coarse.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            fine.triangles.insert(fine.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        return fine;
    }

    Scene scene_;
};

}  // namespace lumel::test
