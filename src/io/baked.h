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

// The lightmap pages of an output folder, in parts of which one is in memory at a time.
class BakedLighting {
public:
    [[nodiscard]] std::uint32_t parts() const { return static_cast<std::uint32_t>(first_page_.size()) - 1; }
    // Reads the pages of a part in place of those of another. Errors: io; invalid_input where the files are others than
    // scene.glb describes.
    Status load(std::uint32_t part);

    // I = E/pi at a point of a world triangle by bilinear lookup, as a GPU would do it; nothing where it has no texels,
    // zero where they are those of a part that is not loaded.
    [[nodiscard]] std::optional<Vec3> irradiance(std::uint32_t triangle, float b1, float b2) const;

private:
    friend Result<BakedLighting> read_baked(const std::filesystem::path&, const Scene&, const WorldGeometry&,
                                            std::uint64_t);
    struct Page {
        std::filesystem::path file;
        std::uint32_t width = 0, height = 0;
        Image image;  // I = E/pi, R, G, B; empty where not loaded
    };
    void cut_into_parts(std::uint64_t max_bytes);

    std::vector<Page> pages_;
    std::vector<std::uint32_t> first_page_;  // of each part, plus one past the end
    std::uint32_t loaded_ = kNone;
    std::vector<BakedTriangle> triangles_;
};

// Bytes that a page takes once it is loaded; as much again while it is being read.
constexpr std::uint64_t loaded_page_bytes(std::uint64_t texels) { return texels * sizeof(Vec3); }

// Reads scene.glb of an output folder and loads the first part of its lightmap pages. `max_bytes`: of the pages of a
// part that has more than one, reading included; 0: all pages are one part.
Result<BakedLighting> read_baked(const std::filesystem::path& folder, const Scene& scene, const WorldGeometry& geometry,
                                 std::uint64_t max_bytes = 0);

// Names the baked geometry: world positions and triangles of all instances.
std::string hash_geometry(const WorldGeometry& geometry);

// Bilinear, texel centres at i + 0.5, clamped at the edges; 3 channels.
Vec3 sample_bilinear(const Image& image, Vec2 uv);

}  // namespace lumel
