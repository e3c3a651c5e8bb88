#include "glb_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/image_io.h"

namespace lumel::samples {
namespace {

constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kFloat = 5126, kUint32 = 5125;
constexpr float kTau = 6.28318530718f;

Json array3(Vec3 v) { return {v.x, v.y, v.z}; }

void append_u32(std::vector<std::byte>& out, std::uint32_t value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    out.insert(out.end(), bytes, bytes + 4);
}

// Rotation whose columns are x, y, z, as a quaternion (x, y, z, w).
Json quaternion(Vec3 x, Vec3 y, Vec3 z) {
    const float trace = x.x + y.y + z.z;
    float q[4];
    if (trace > 0.0f) {
        const float s = 2.0f * std::sqrt(trace + 1.0f);
        q[3] = 0.25f * s;
        q[0] = (y.z - z.y) / s;
        q[1] = (z.x - x.z) / s;
        q[2] = (x.y - y.x) / s;
    } else if (x.x > y.y && x.x > z.z) {
        const float s = 2.0f * std::sqrt(1.0f + x.x - y.y - z.z);
        q[3] = (y.z - z.y) / s;
        q[0] = 0.25f * s;
        q[1] = (y.x + x.y) / s;
        q[2] = (z.x + x.z) / s;
    } else if (y.y > z.z) {
        const float s = 2.0f * std::sqrt(1.0f + y.y - x.x - z.z);
        q[3] = (z.x - x.z) / s;
        q[0] = (y.x + x.y) / s;
        q[1] = 0.25f * s;
        q[2] = (z.y + y.z) / s;
    } else {
        const float s = 2.0f * std::sqrt(1.0f + z.z - x.x - y.y);
        q[3] = (x.y - y.x) / s;
        q[0] = (z.x + x.z) / s;
        q[1] = (z.y + y.z) / s;
        q[2] = 0.25f * s;
    }
    return {q[0], q[1], q[2], q[3]};
}

}  // namespace

void Geometry::quad(Vec3 origin, Vec3 u, Vec3 v, float uv_scale) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    const Vec3 normal = normalize(cross(u, v));
    const float width = length(u) * uv_scale, height = length(v) * uv_scale;
    for (const auto& [s, t] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
        positions.push_back(origin + u * s + v * t);
        normals.push_back(normal);
        uv.push_back({s * width, t * height});
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
}

void Geometry::box(Vec3 low, Vec3 high, bool inward) {
    const Vec3 d = high - low;
    const Vec3 x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    const auto face = [&](Vec3 origin, Vec3 u, Vec3 v) { inward ? quad(origin, v, u) : quad(origin, u, v); };
    face(low, y, x);
    face(low + z, x, y);
    face(low, z, y);
    face(low + x, y, z);
    face(low, x, z);
    face(low + y, z, x);
}

void Geometry::revolve(Vec3 centre, std::span<const Vec2> profile, std::uint32_t sides) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    const auto rings = static_cast<std::uint32_t>(profile.size());
    for (std::uint32_t r = 0; r < rings; ++r) {
        const Vec2 before = profile[r == 0 ? 0 : r - 1], after = profile[std::min(r + 1, rings - 1)];
        const Vec2 slope = after - before;
        for (std::uint32_t s = 0; s <= sides; ++s) {
            const float angle = kTau * static_cast<float>(s % sides) / static_cast<float>(sides);
            const float c = std::cos(angle), n = std::sin(angle);
            positions.push_back(centre + Vec3{profile[r].x * c, profile[r].y, -profile[r].x * n});
            normals.push_back(normalize_or({slope.y * c, -slope.x, -slope.y * n}, {0, 1, 0}));
            uv.push_back({static_cast<float>(s) / static_cast<float>(sides), profile[r].y});
        }
    }
    const std::uint32_t stride = sides + 1;
    for (std::uint32_t r = 0; r + 1 < rings; ++r)
        for (std::uint32_t s = 0; s < sides; ++s) {
            const std::uint32_t a = first + r * stride + s, b = a + 1, c = a + stride, d = c + 1;
            if (profile[r].x > 0.0f) indices.insert(indices.end(), {a, b, d});
            if (profile[r + 1].x > 0.0f) indices.insert(indices.end(), {a, d, c});
        }
}

void Geometry::sphere(Vec3 centre, float radius, std::uint32_t rings, std::uint32_t sides) {
    std::vector<Vec2> profile;
    for (std::uint32_t r = 0; r <= rings; ++r) {
        const float angle = 0.5f * kTau * static_cast<float>(r) / static_cast<float>(rings);
        const bool pole = r == 0 || r == rings;
        profile.push_back({pole ? 0.0f : radius * std::sin(angle), -radius * std::cos(angle)});
    }
    const std::size_t first = positions.size();
    revolve(centre, profile, sides);
    for (std::size_t i = first; i < positions.size(); ++i) normals[i] = normalize(positions[i] - centre);
}

int GlbBuilder::add_view(std::span<const std::byte> data, int target) {
    buffer_.resize((buffer_.size() + 3) & ~std::size_t{3});
    Json view{{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", data.size()}};
    if (target) view["target"] = target;
    buffer_.insert(buffer_.end(), data.begin(), data.end());
    root_["bufferViews"].push_back(std::move(view));
    return static_cast<int>(root_["bufferViews"].size()) - 1;
}

template <class T>
int GlbBuilder::add_accessor(std::span<const T> data, int component, const char* type, int target, bool bounds) {
    Json accessor{{"bufferView", add_view(std::as_bytes(data), target)},
                  {"componentType", component},
                  {"count", data.size()},
                  {"type", type}};
    if constexpr (std::is_same_v<T, Vec3>)
        if (bounds && !data.empty()) {
            Vec3 low = data[0], high = data[0];
            for (const Vec3& p : data) {
                low = min(low, p);
                high = max(high, p);
            }
            accessor["min"] = array3(low);
            accessor["max"] = array3(high);
        }
    root_["accessors"].push_back(std::move(accessor));
    return static_cast<int>(root_["accessors"].size()) - 1;
}

int GlbBuilder::add_material(Json material) {
    root_["materials"].push_back(std::move(material));
    return static_cast<int>(root_["materials"].size()) - 1;
}

int GlbBuilder::add_png_texture(std::span<const std::byte> png) {
    root_["images"].push_back({{"bufferView", add_view(png, 0)}, {"mimeType", "image/png"}});
    root_["textures"].push_back({{"source", root_["images"].size() - 1}});
    return static_cast<int>(root_["textures"].size()) - 1;
}

int GlbBuilder::add_mesh(const std::string& name, std::span<const Geometry> primitives) {
    Json mesh{{"name", name}, {"primitives", Json::array()}};
    for (const Geometry& g : primitives) {
        Json attributes;
        attributes["POSITION"] = add_accessor<Vec3>(g.positions, kFloat, "VEC3", kArrayBuffer, true);
        if (!g.normals.empty())
            attributes["NORMAL"] = add_accessor<Vec3>(g.normals, kFloat, "VEC3", kArrayBuffer, false);
        if (!g.uv.empty()) attributes["TEXCOORD_0"] = add_accessor<Vec2>(g.uv, kFloat, "VEC2", kArrayBuffer, false);
        const int indices = add_accessor<std::uint32_t>(g.indices, kUint32, "SCALAR", kElementArrayBuffer, false);
        mesh["primitives"].push_back({{"attributes", attributes}, {"indices", indices}, {"material", g.material}});
    }
    root_["meshes"].push_back(std::move(mesh));
    return static_cast<int>(root_["meshes"].size()) - 1;
}

int GlbBuilder::add_node(Json node) {
    root_["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(root_["nodes"].size()) - 1;
    root_["scenes"][0]["nodes"].push_back(index);
    return index;
}

int GlbBuilder::add_light(Json light) {
    use_extension("KHR_lights_punctual");
    Json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(light));
    return static_cast<int>(lights.size()) - 1;
}

int GlbBuilder::add_perspective_camera(float vertical_fov) {
    root_["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", vertical_fov}, {"znear", 0.05}}}});
    return static_cast<int>(root_["cameras"].size()) - 1;
}

void GlbBuilder::use_extension(const std::string& name) {
    Json& used = root_["extensionsUsed"];
    if (used.is_null()) used = Json::array();
    if (std::find(used.begin(), used.end(), Json(name)) == used.end()) used.push_back(name);
}

std::vector<std::byte> GlbBuilder::bytes() const {
    Json root = root_;
    root["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    std::string json = root.dump();
    json.resize((json.size() + 3) & ~std::size_t{3}, ' ');
    const std::size_t binary = (buffer_.size() + 3) & ~std::size_t{3};
    std::vector<std::byte> out;
    append_u32(out, 0x46546c67u);  // "glTF"
    append_u32(out, 2);
    append_u32(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary));
    append_u32(out, static_cast<std::uint32_t>(json.size()));
    append_u32(out, 0x4e4f534au);  // "JSON"
    const auto* text = reinterpret_cast<const std::byte*>(json.data());
    out.insert(out.end(), text, text + json.size());
    append_u32(out, static_cast<std::uint32_t>(binary));
    append_u32(out, 0x004e4942u);  // "BIN"
    out.insert(out.end(), buffer_.begin(), buffer_.end());
    out.resize(out.size() + binary - buffer_.size());
    return out;
}

Status GlbBuilder::write(const std::filesystem::path& path) const { return write_file(path, bytes()); }

Json make_material(const std::string& name, Vec3 base_color) {
    return {{"name", name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {base_color.x, base_color.y, base_color.z, 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}}}};
}

Json make_node_looking(const std::string& name, Vec3 position, Vec3 direction) {
    const Vec3 z = normalize(-direction);
    const Vec3 x = normalize_or(cross({0, 1, 0}, z), {1, 0, 0});
    return {{"name", name}, {"translation", array3(position)}, {"rotation", quaternion(x, cross(z, x), z)}};
}

}  // namespace lumel::samples
