// The scene as Lumel bakes it: plain arrays, world units, linear Rec. 709 colour. Right-handed, Y up, metres.
//
// Two geometries are kept apart. `meshes` and `instances` are what is *baked*: charts are made of them and rays hit
// them. `display` is what is *shown*: it receives lightmap UVs and page ids and nothing else. They are the same today;
// no stage may assume it (see `Display`).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lumel/vec.h"

namespace lumel {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

using Triangle = std::array<std::uint32_t, 3>;

// ---- Surfaces -------------------------------------------------------------------------------------------------------

// 8-bit RGBA texels, row 0 at v = 0. `srgb` says how R, G, B are coded; A is always linear.
struct Texture {
    std::string name;
    std::uint32_t width = 0, height = 0;
    bool srgb = true;
    std::vector<std::uint8_t> rgba;  // width * height * 4
};

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

// Which texture, which UV set, and KHR_texture_transform as the affine map uv' = (a*u + b*v + c, d*u + e*v + f).
struct TextureRef {
    std::uint32_t texture = kNone;  // index into Scene::textures
    std::uint8_t uv_set = 0;        // 0 or 1
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;
    std::array<float, 6> transform{1, 0, 0, 0, 1, 0};
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

// A Lambertian surface. Metals are taken as diffuse with their base colour, so that they do not swallow light.
struct Material {
    std::string name;
    Vec3 base_color{1, 1, 1};  // linear, 0..1; times texture, times vertex colour
    float alpha = 1.0f;
    TextureRef base_color_texture;
    Vec3 emission{};  // radiance in nits: emissiveFactor * emissiveStrength; times texture
    TextureRef emission_texture;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
};

// One glTF primitive within a mesh: consecutive vertices and triangles.
struct Primitive {
    std::uint32_t first_vertex = 0, vertex_count = 0;
    std::uint32_t first_triangle = 0, triangle_count = 0;
    std::uint32_t material = kNone;  // kNone: glTF's default material
};

// Arrays are per vertex; an absent attribute is an empty array. Positions and normals are in mesh space.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  // unit; made from the faces where the file had none, never empty
    std::vector<Vec2> uv0, uv1;
    std::vector<Vec4> colors;  // linear COLOR_0
    std::vector<Triangle> triangles;
    std::vector<Primitive> primitives;  // cover all vertices and triangles, in order
};

// ---- What is baked --------------------------------------------------------------------------------------------------

enum class NodeClass : std::uint8_t {
    lightmap,  // gets texels, blocks and bounces light
    volume,    // no texels (lit by the irradiance volume), blocks and bounces light
    probe,     // small, skinned or animated: no texels, neither blocks nor bounces light
    occluder,  // no texels, blocks light and bounces none
    ignored,   // not there at all
};

struct Instance {
    std::string name;  // of the node; instances of EXT_mesh_gpu_instancing append "#k"
    std::uint32_t mesh = kNone;
    Affine transform;  // mesh to world
    NodeClass node_class = NodeClass::lightmap;
    float density_scale = 1.0f;   // times the texel density of the bake
    bool class_is_asked = false;  // by the file or the sidecar: bad charts do not change it
    // Hash of the names of the nodes from the root down to this one: which object this is, in an edited file, too. Need
    // not be unique. Changes no light.
    std::uint64_t path_hash = 0;
};

// ---- Lights ---------------------------------------------------------------------------------------------------------

enum class LightShape : std::uint8_t { sun, point, spot, rectangle, disc, sphere };
enum class LightBake : std::uint8_t { all, indirect, none };

// glTF's units: sun lux (on a plane facing it), point and spot candela, rectangle, disc and sphere nits (radiance).
struct Light {
    std::string name;
    LightShape shape = LightShape::point;
    Vec3 intensity{1, 1, 1};  // colour times strength, in the unit of the shape
    Vec3 position{};
    Vec3 direction{0, 0,
                   -1};  // unit: the way light travels (sun, spot), or the normal of the lit side (rectangle, disc)
    Vec3 half_u{}, half_v{};  // rectangle: half edges, half_u x half_v along direction; disc: two radii
    float radius = 0.0f;      // point, spot, sphere: metres; 0 = a point
    float range = 0.0f;       // point, spot: KHR_lights_punctual's range in metres; 0 = infinite
    float inner_cone = 0.0f, outer_cone = 0.785398163f;  // spot: half angles in radians
    float angular_diameter = 0.0f;                       // sun: radians; 0 = a point at infinity
    LightBake bake = LightBake::all;                     // artist control: which layers get this light
    float indirect_scale = 1.0f;                         // artist control: times its bounced light
    Vec3 indirect_color{1, 1, 1};                        // artist control: tint of its bounced light
};

// Equirectangular radiance, three planes interleaved; direction d is found at u = atan2(d.z, d.x)/(2 pi) + 0.5,
// v = 0.5 - asin(d.y)/pi, row 0 up, after turning d by -rotation about +Y.
struct SkyMap {
    std::uint32_t width = 0, height = 0;
    std::vector<Vec3> radiance;  // width * height
};

struct Sky {
    Vec3 color{};               // constant radiance in nits; used where there is no map
    std::optional<SkyMap> map;  // already scaled to nits
    float rotation = 0.0f;      // radians about +Y, counter-clockwise seen from above
    [[nodiscard]] bool is_black() const { return !map && color == Vec3{}; }
};

// ---- What is displayed ----------------------------------------------------------------------------------------------

// Where a displayed mesh came from, so that `io` can write it back.
struct DisplaySource {
    std::uint32_t gltf_node = kNone;
    std::uint32_t gltf_mesh = kNone;
    std::uint32_t instancing_index = kNone;  // of EXT_mesh_gpu_instancing; kNone where the node has none
};

struct DisplayInstance {
    DisplaySource source;
    std::uint32_t mesh = kNone;            // index into Display::meshes
    std::uint32_t baked_instance = kNone;  // whose charts it takes; kNone: not lightmapped
};

// Lightmap UVs go from a baked instance to its displayed instance by `lift` (see chart/lift.h): the identity, corner by
// corner, where both share one Mesh object. Proxies and LODs will bring a projection.
struct Display {
    std::vector<std::shared_ptr<const Mesh>> meshes;
    std::vector<DisplayInstance> instances;
};

struct Camera {
    std::string name;
    Affine transform;                   // camera to world; looks along -Z, up is +Y
    float vertical_fov = 0.785398163f;  // radians
    float aspect = 0.0f;                // 0: that of the picture
};

struct Scene {
    std::string source;  // file it came from, for messages
    std::vector<Texture> textures;
    std::vector<Material> materials;  // the last one is glTF's default material; Primitive::material kNone means it
    std::vector<std::shared_ptr<const Mesh>> meshes;
    std::vector<Instance> instances;
    Display display;
    std::vector<Light> lights;
    Sky sky;
    std::vector<Camera> cameras;
};

}  // namespace lumel
