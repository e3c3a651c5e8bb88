// From the bytes of a .glb or .gltf to a GltfDocument: chunks, JSON, required extensions, buffers, buffer views.
#pragma once

#include "io/gltf_document_internal.h"

namespace lumel {

// `path` is where external files are looked for; empty refuses them. `where` names the file in messages.
Result<GltfDocumentPtr> read_document(std::vector<std::byte> bytes, const std::filesystem::path& path,
                                      const std::string& where);

// Extensions that Lumel reads, or that are harmless to a diffuse bake, or that come with a fallback.
bool is_known_extension(const std::string& name);

// The decoded content of a view that carries EXT_meshopt_compression (`extension` is that object).
struct MeshoptView {
    std::vector<std::byte> bytes;
    std::size_t stride = 0;  // 0 for indices: tightly packed
};
Result<MeshoptView> decode_meshopt_view(const GltfDocument& document, const Json& extension, const std::string& where);

}  // namespace lumel
