// The output of a bake, read back: which point of the scene looks up which place of which lightmap page.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "scene/world_geometry.h"

namespace lumel {

// Lightmap UVs of a world triangle, 0..1 over the page; page kNone: no texels.
struct BakedTriangle {
    std::uint32_t page = kNone;
    std::array<Vec2, 3> uv{};
};

// Per world triangle of `geometry`, as scene.glb stores them: what a viewer would use. `geometry` is that of the scene
// that was baked. Errors: io; invalid_input where the file is no scene of ours or one of another scene.
Result<std::vector<BakedTriangle>> read_baked_uvs(const std::filesystem::path& scene_glb, const Scene& scene,
                                                  const WorldGeometry& geometry);

struct BakedLighting {
    std::vector<Image> pages;  // I = E/pi, R, G, B
    std::vector<BakedTriangle> triangles;

    // I = E/pi at a point of a world triangle by bilinear lookup, as a GPU would do it; nothing where it has no texels.
    [[nodiscard]] std::optional<Vec3> irradiance(std::uint32_t triangle, float b1, float b2) const;
};

// Reads scene.glb and the lightmap pages of an output folder.
Result<BakedLighting> read_baked(const std::filesystem::path& folder, const Scene& scene,
                                 const WorldGeometry& geometry);

// Names the baked geometry: world positions and triangles of all instances.
std::string hash_geometry(const WorldGeometry& geometry);

// Bilinear, texel centres at i + 0.5, clamped at the edges; 3 channels.
Vec3 sample_bilinear(const Image& image, Vec2 uv);

}  // namespace lumel
