// glTF documents made in code: a JSON root and one buffer, written as .glb or as .gltf with the buffer embedded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumel::test {

class GltfBuilder {
public:
    using Json = nlohmann::ordered_json;

    Json root = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::byte> binary;

    // A view of the bytes, which begin at a multiple of four.
    std::size_t view(std::span<const std::byte> bytes, std::size_t stride = 0) {
        binary.resize((binary.size() + 3) / 4 * 4);
        Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
        if (stride != 0) view["byteStride"] = stride;
        binary.insert(binary.end(), bytes.begin(), bytes.end());
        return add("bufferViews", std::move(view));
    }
    std::size_t accessor(std::size_t view, int component_type, const char* type, std::size_t count,
                         bool normalized = false) {
        Json json{{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}};
        if (normalized) json["normalized"] = true;
        return add("accessors", std::move(json));
    }
    // An accessor with a view of its own; `values` are all components of all elements.
    template <class T>
    std::size_t accessor(const std::vector<T>& values, const char* type, bool normalized = false) {
        return accessor(view(std::as_bytes(std::span(values))), component_type<T>(), type,
                        values.size() / components(type), normalized);
    }
    std::size_t add(const char* array, Json json) {
        root[array].push_back(std::move(json));
        return root[array].size() - 1;
    }
    // A mesh of one primitive.
    std::size_t mesh(Json attributes, Json rest = Json::object()) {
        rest["attributes"] = std::move(attributes);
        return add("meshes", {{"primitives", Json::array({std::move(rest)})}});
    }
    std::size_t node(Json json) { return add("nodes", std::move(json)); }

    // One triangle (0,0,0) (1,0,0) (0,1,0) with normals +z; returns its mesh.
    std::size_t triangle() {
        const std::size_t positions = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        const std::size_t normals = accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        return mesh({{"POSITION", positions}, {"NORMAL", normals}});
    }
    // The same, in the scene.
    std::size_t triangle_node() { return node({{"mesh", triangle()}}); }

    [[nodiscard]] std::vector<std::byte> glb() const {
        Json json = root;
        if (!json.contains("buffers") && !binary.empty())
            json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
        std::string text = json.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<std::byte> padded = binary;
        padded.resize((padded.size() + 3) / 4 * 4);
        std::vector<std::byte> out;
        const std::size_t chunks = binary.empty() ? 8 + text.size() : 16 + text.size() + padded.size();
        for (const std::size_t word : {std::size_t{0x46546c67}, std::size_t{2}, 12 + chunks}) append_u32(out, word);
        append_chunk(out, 0x4e4f534a, std::as_bytes(std::span(text)));
        if (!binary.empty()) append_chunk(out, 0x004e4942, padded);
        return out;
    }
    [[nodiscard]] std::string gltf() const {
        Json json = root;
        json["buffers"] =
            Json::array({{{"byteLength", binary.size()}, {"uri", data_uri("application/octet-stream", binary)}}});
        return json.dump();
    }

    static std::string data_uri(const std::string& type, std::span<const std::byte> bytes) {
        static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out = "data:" + type + ";base64,";
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 3; ++k)
                bits = bits << 8 | (k < have ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
            for (std::size_t k = 0; k < 4; ++k) out += k <= have ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
        }
        return out;
    }

private:
    template <class T>
    static constexpr int component_type() {
        if constexpr (std::is_same_v<T, float>) return 5126;
        if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
        if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
        if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
        if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
        if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
        return 0;
    }
    static std::size_t components(std::string_view type) {
        if (type == "SCALAR") return 1;
        if (type == "MAT4") return 16;
        return static_cast<std::size_t>(type.back() - '0');
    }
    static void append_u32(std::vector<std::byte>& out, std::size_t value) {
        for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i) & 255));
    }
    static void append_chunk(std::vector<std::byte>& out, std::size_t type, std::span<const std::byte> data) {
        append_u32(out, data.size());
        append_u32(out, type);
        out.insert(out.end(), data.begin(), data.end());
    }
};

}  // namespace lumel::test
