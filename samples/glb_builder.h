// Builds small .glb files in code: meshes from boxes, quads and surfaces of revolution, materials, nodes, lights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "lumel/result.h"
#include "lumel/vec.h"

namespace lumel::samples {

using Json = nlohmann::ordered_json;

// Triangles of one primitive. Corners are counter-clockwise seen from the front.
struct Geometry {
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uv;
    std::vector<std::uint32_t> indices;
    int material = 0;

    // origin + s*u + t*v for s, t in [0, 1]; the front is u x v. UV0 in metres times `uv_scale`.
    void quad(Vec3 origin, Vec3 u, Vec3 v, float uv_scale = 1.0f);
    // Closed box, fronts outward (or inward: a room).
    void box(Vec3 low, Vec3 high, bool inward = false);
    // Profile (radius, height) turned about +Y at `centre`, bottom to top, smooth-shaded; `sides` facets.
    void revolve(Vec3 centre, std::span<const Vec2> profile, std::uint32_t sides);
    void sphere(Vec3 centre, float radius, std::uint32_t rings, std::uint32_t sides);
};

class GlbBuilder {
public:
    // Returns the index. `material` is glTF's object; see make_material for the common case.
    int add_material(Json material);
    int add_png_texture(std::span<const std::byte> png);
    int add_mesh(const std::string& name, std::span<const Geometry> primitives);
    int add_node(Json node);
    int add_light(Json light);  // KHR_lights_punctual
    int add_perspective_camera(float vertical_fov);
    void use_extension(const std::string& name);

    [[nodiscard]] Status write(const std::filesystem::path& path) const;
    [[nodiscard]] std::vector<std::byte> bytes() const;

private:
    int add_view(std::span<const std::byte> data, int target);
    template <class T>
    int add_accessor(std::span<const T> data, int component, const char* type, int target, bool bounds);

    Json root_ = {{"asset", {{"version", "2.0"}, {"generator", "lumel samples"}}},
                  {"scene", 0},
                  {"scenes", Json::array({{{"nodes", Json::array()}}})}};
    std::vector<std::byte> buffer_;
};

Json make_material(const std::string& name, Vec3 base_color);
// Node at a point that looks along `direction` (-Z), up +Y.
Json make_node_looking(const std::string& name, Vec3 position, Vec3 direction);

}  // namespace lumel::samples
