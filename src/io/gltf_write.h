// Writes scene.glb: the file that was read, lit by the bake, right in viewers that know nothing of Lumel.
//
// Every lightmapped instance becomes a mesh of its own with its lightmap UVs as TEXCOORD_1; positions, normals, all
// other attributes and indices are stored once. Materials are replaced by clones that show albedo x E/pi as emission;
// the originals stay. Lights whose direct light is in the bake are taken off their nodes and kept in the nodes' extras.
// Everything else of the file survives: animations, skins, cameras, unknown extensions, extras. Data that was
// compressed (EXT_meshopt_compression) is written plain; quantised data stays quantised. Layout and extension:
// docs/formats.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "chart/chart_set.h"
#include "io/gltf_document.h"
#include "lumel/options.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// The no-code form of one page.
struct LitTexture {
    std::vector<std::byte> png;  // RGB8 in sRGB code: albedo x E/pi (plus the surface's own emission) over `strength`
    float strength = 1.0f;
    // Reflected light that is too bright for it: how many texels it was cut in, and how many times the brightest was.
    std::uint64_t cut_texels = 0;
    float cut_ratio = 1.0f;
};

struct GltfWriteInput {
    const GltfDocument& document;
    const Scene& scene;  // as it was loaded from the document
    const ChartSet& charts;
    const Atlas& atlas;
    std::span<const LitTexture> textures;  // one per page of the atlas
    Include include;
    std::string geometry_hash;  // of the baked geometry (baked.h), kept for those who read the UVs back
};

// Errors: io; invalid_input where the document holds what the reader did not have to look at and JSON cannot express.
Status write_lit_gltf(const std::filesystem::path& path, const GltfWriteInput& input);

}  // namespace lumel
