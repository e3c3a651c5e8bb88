// The inside of GltfDocument: the JSON as it was read and the bytes it points to. Shared by the reader and the writer,
// both in io; JSON never leaves this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/gltf_document.h"
#include "io/json_read.h"
#include "lumel/result.h"

namespace lumel {

// glTF's componentType.
enum class Component : std::uint16_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126,
};
[[nodiscard]] std::size_t component_size(Component component);

// One accessor, ready to use: sparse values applied, meshopt decoded, elements tightly packed (matrix columns without
// padding), but numbers still as the file stores them.
struct AccessorBytes {
    Component component = Component::float32;
    bool normalized = false;
    std::uint32_t components = 1;  // per element: 1 for SCALAR .. 4 for VEC4, 4, 9, 16 for matrices
    std::uint64_t count = 0;       // elements
    std::vector<std::byte> bytes;  // count * components * component_size

    // Component c of element i as a float, normalised integers mapped to [0, 1] or [-1, 1] as glTF says.
    [[nodiscard]] float number(std::uint64_t i, std::uint32_t c) const;
    // The same of unsigned integer accessors (indices). Precondition: component is uint8, uint16 or uint32.
    [[nodiscard]] std::uint32_t index(std::uint64_t i) const;
};

// Where the vertices of a Mesh came from. A glTF primitive that was skipped (points, lines) has no entry, so that
// `primitives` runs parallel to Mesh::primitives.
struct PrimitiveSource {
    std::uint32_t gltf_primitive = kNone;  // index into meshes[gltf_mesh].primitives
    // Mesh vertex (relative to Primitive::first_vertex) -> element of the primitive's attribute accessors. Empty means
    // the identity. Not the identity where NORMAL was absent (each corner became a vertex of its own) and where the
    // indices use only a part of a shared vertex buffer.
    std::vector<std::uint32_t> vertex;
    [[nodiscard]] std::uint32_t element(std::uint32_t v) const { return vertex.empty() ? v : vertex[v]; }
    bool made_normals = false;  // the file has no NORMAL for it; the Mesh's are those of the faces
};

struct MeshSource {
    std::uint32_t gltf_mesh = kNone;
    std::vector<PrimitiveSource> primitives;
};

class GltfDocument {
public:
    Json root;                       // the whole document, unknown extensions and extras included
    std::filesystem::path path;      // the file; empty where it was read from memory
    std::string where;               // how messages name it
    std::vector<MeshSource> meshes;  // one per Scene::meshes (and Display::meshes, which share the Mesh objects)

    // The data of root["buffers"][i]; empty for the fallback buffers of EXT_meshopt_compression.
    std::vector<std::vector<std::byte>> buffers;
    // The data of root["bufferViews"][i], EXT_meshopt_compression undone; points into this object. Every view was
    // checked against its buffer when the file was read.
    std::vector<std::span<const std::byte>> views;
    std::vector<std::size_t> view_strides;              // byteStride; 0 = tightly packed
    std::vector<std::vector<std::byte>> decoded_views;  // storage of the decoded ones
    // One per Scene::lights: the node whose KHR_lights_punctual it is, kNone for lights of the sidecar. The writer
    // removes lights that are baked by it; where the reader left it empty, all punctual lights count as baked.
    std::vector<std::uint32_t> light_nodes;
    std::uint64_t file_bytes = 0;  // the file and its external buffers: bounds what it may expand to

    // Errors: an index or count out of range, wrong types, more elements than such a small file may ask for.
    [[nodiscard]] Result<AccessorBytes> accessor_bytes(std::uint64_t accessor) const;

    // The encoded file (PNG, JPEG) of root["images"][i] from its bufferView, data: URI or external file.
    [[nodiscard]] Result<std::vector<std::byte>> image_bytes(std::uint64_t image) const;

    // Where external files are looked for; empty where they are refused.
    [[nodiscard]] std::filesystem::path base_directory() const {
        return path.empty() ? path : path.has_parent_path() ? path.parent_path() : ".";
    }
};

}  // namespace lumel
