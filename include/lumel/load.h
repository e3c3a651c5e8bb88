// Scenes and layouts from files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "lumel/context.h"
#include "lumel/options.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// The file's JSON and buffers, kept so that it can be written back losslessly. Opaque: JSON stays inside io/*.cpp.
class GltfDocument;
struct GltfDocumentDeleter {
    void operator()(GltfDocument* document) const;
};
using GltfDocumentPtr = std::unique_ptr<GltfDocument, GltfDocumentDeleter>;

struct LoadedScene {
    Scene scene;
    GltfDocumentPtr document;
    std::string sky_hash = {};  // of the sky map's file, where the options' sky replaced the scene's
};

// Reads .glb or .gltf (external or embedded buffers and images), then `<scene>.lumel.json` beside it where present.
// Errors name file, object and remedy; never crashes or takes more than bounded time and memory on hostile bytes.
// Diagnostics: "skipped-primitive" (points, lines), "missing-normals", "ignored-extension", "diffuse-transmission",
// "zero-length-normal", "node-class" (nodes not lightmapped, and why), "already-baked" (a scene.glb of ours).
Result<LoadedScene> load_scene(const std::filesystem::path& path, Context& context);

// The same, then the sky map named by options.sky.file, then apply_lighting(): what bake() and bake_to_folder() take.
Result<LoadedScene> load_lit_scene(const std::filesystem::path& path, const BakeOptions& options, Context& context);

// The layout of an earlier bake, from its manifest.json or atlas.json: for BakeOptions::atlas. Errors: io;
// invalid_input where it is no manifest, an older one that does not name its charts, or one whose numbers cannot be a
// layout. Whether boxes lie on top of each other is not looked at (bake() does).
Result<std::shared_ptr<const AtlasRecord>> read_atlas_record(const std::filesystem::path& file);

}  // namespace lumel
