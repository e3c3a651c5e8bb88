// A glTF file as its JSON document and its buffers, kept so that it can be written back losslessly.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// JSON stays inside io/*.cpp: the document is opaque here.
class GltfDocument;
struct GltfDocumentDeleter {
    void operator()(GltfDocument* document) const;
};
using GltfDocumentPtr = std::unique_ptr<GltfDocument, GltfDocumentDeleter>;

struct LoadedScene {
    Scene scene;
    GltfDocumentPtr document;
    std::string sky_hash = {};  // of the sky map's file, where the caller replaced the scene's sky by one
};

// Reads .glb or .gltf (external or embedded buffers and images), then `<scene>.lumel.json` beside it where present.
// Errors name file, object and remedy; never crashes or takes more than bounded time and memory on hostile bytes.
// Diagnostics: "skipped-primitive" (points, lines), "missing-normals", "ignored-extension", "diffuse-transmission",
// "zero-length-normal", "node-class" (nodes not lightmapped, and why), "already-baked" (a scene.glb of ours).
Result<LoadedScene> load_scene(const std::filesystem::path& path, Context& context);

// The bytes of a .glb (fuzz target; external files are refused).
Result<LoadedScene> load_glb(std::span<const std::byte> bytes, const std::string& where, Context& context);

}  // namespace lumel
