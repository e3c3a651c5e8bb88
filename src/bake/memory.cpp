#include "bake/memory.h"

#include <sys/resource.h>

#include <algorithm>

#include "path/radiance_sums.h"

namespace lumel {
namespace {

// Measured with Embree 3.13 and 4.3 at build quality high: 150 to 190 bytes a triangle at the peak of the build.
constexpr std::uint64_t kTracerBytesPerTriangle = 200;
constexpr std::uint64_t kProgramBytes = 64u << 20;  // code, libraries, allocator slack

// One covered texel: RadianceSums entry, TexelBuffer entry and its share of triangle lists.
constexpr std::uint64_t kBytesPerTexel = kLayerCount * sizeof(LayerMoments) + 4 * sizeof(Vec3) + 4 * sizeof(float) + 80;

}  // namespace

std::uint64_t scene_memory(const Scene& scene, const WorldGeometry& geometry) {
    std::uint64_t bytes = kProgramBytes;
    for (const Texture& texture : scene.textures) bytes += texture.rgba.size();
    for (const auto& mesh : scene.meshes)
        bytes += mesh->positions.size() * (2 * sizeof(Vec3) + 2 * sizeof(Vec2) + sizeof(Vec4)) +
                 mesh->triangles.size() * (sizeof(Triangle) + 3 * sizeof(Vec2) + 2 * sizeof(std::uint32_t));
    bytes += geometry.positions.size() * (2 * sizeof(Vec3) + 2 * sizeof(Vec2) + sizeof(Vec4));
    bytes += geometry.triangles.size() * (sizeof(WorldTriangle) + kTracerBytesPerTriangle);
    if (scene.sky.map) bytes += scene.sky.map->radiance.size() * (sizeof(Vec3) + 12);
    return bytes;
}

std::uint64_t page_memory(const AtlasPage& page) {
    const std::uint64_t texels = std::uint64_t{page.width} * page.height;
    return texels * (kBytesPerTexel + 2 * sizeof(std::uint32_t));
}

std::uint64_t largest_page_memory(const Atlas& atlas) {
    std::uint64_t largest = 0;
    for (const AtlasPage& page : atlas.pages) largest = std::max(largest, page_memory(page));
    return largest;
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024u;
}

}  // namespace lumel
