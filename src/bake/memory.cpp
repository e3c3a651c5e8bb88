#include "bake/memory.h"

#include <sys/resource.h>

#include <algorithm>

#include "path/radiance_sums.h"

namespace lumel {
namespace {

// Measured with Embree 3.13 and 4.3 at build quality high: 150 to 190 bytes a triangle at the peak of the build.
constexpr std::uint64_t kTracerBytesPerTriangle = 200;
constexpr std::uint64_t kProgramBytes = 64u << 20;  // code, libraries, allocator slack

// One texel of a page that is covered all over, which is the most there is: dilated texels take no more than covered
// ones, and the sums have room for them from the start, so that no array is held twice while it grows.
constexpr std::uint64_t kSumsBytes =
    kLayerCount * sizeof(LayerMoments) + 2 * sizeof(Vec3) + 2 * sizeof(float) + 2 * sizeof(std::uint32_t);
// x, y, valid points, owner, position, normal, size; start and share of the triangle lists.
constexpr std::uint64_t kTexelBufferBytes = 4 + 8 + 4 + 2 * sizeof(Vec3) + 4 + 4 + 12;
// Albedo, emission, coverage, chart; queue of the fill or guides of the denoiser, of which one lives at a time.
constexpr std::uint64_t kLightmapBytes = 2 * sizeof(Vec3) + 1 + 4 + 2 * sizeof(Vec3);
constexpr std::uint64_t kBytesPerTexel = kSumsBytes + kTexelBufferBytes + kLightmapBytes;
constexpr std::uint64_t kBytesPerPixel = 3 * sizeof(std::uint32_t);  // texel_at of both, readers

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
    return texels * (kBytesPerTexel + kBytesPerPixel);
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
