#include "bake/memory.h"

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
constexpr std::uint64_t kBytesPerPixel = 3 * sizeof(std::uint32_t);  // texel_at of both, readers

// Rows of the master, the widest file, on one thread: a block, and two chunks that OpenEXR compresses, each with what
// went in, what comes out and room to sort the bytes in.
constexpr std::uint64_t kRowsPerThread = 16;
constexpr std::uint64_t kMasterPixelBytes = sizeof(float) * (kLayerCount * (3 * kShCoefficients + 3) + 5);
constexpr std::uint64_t kCopiesOfRows = 1 + 2 * 3;

// Of a page, once it is written, there stay: previews of at most this edge (irradiance, count, coverage), and the
// picture for scene.glb, which noise does not let compress by much.
constexpr std::uint64_t kPreviewEdge = 1024;
constexpr std::uint64_t kPreviewBytes = 4 * sizeof(float) + 1;
constexpr std::uint64_t kPictureBytes = 3;

// Both atlases, and packing.
constexpr std::uint64_t kPlacementBytes = 2 * sizeof(ChartPlacement) + 32;
// Trees of JSON. Measured on a town of 20,000 instances of one primitive and 21 charts each: about 5,500 bytes an
// instance in scene.glb, 110 a chart in the manifest.
constexpr std::uint64_t kGlbBytesPerInstance = 4000, kGlbBytesPerPrimitive = 4000;
constexpr std::uint64_t kManifestBytesPerChart = 200;
constexpr std::uint64_t kBakedTriangleBytes = 28;  // of the views

std::uint64_t pixels_of(const AtlasPage& page) { return std::uint64_t{page.width} * page.height; }

std::uint64_t preview_pixels(const AtlasPage& page) {
    const std::uint64_t block = (std::max(page.width, page.height) + kPreviewEdge - 1) / kPreviewEdge;
    return pixels_of(page) / (block * block);
}

std::uint64_t picture_memory(const Atlas& atlas) {
    std::uint64_t bytes = 0;
    for (const AtlasPage& page : atlas.pages) bytes += pixels_of(page) * kPictureBytes;
    return bytes;
}

std::uint64_t preview_memory(const Atlas& atlas) {
    std::uint64_t bytes = 0;
    for (const AtlasPage& page : atlas.pages) bytes += preview_pixels(page) * kPreviewBytes;
    return bytes;
}

std::uint64_t vertex_bytes(std::size_t vertices) {
    return vertices * (2 * sizeof(Vec3) + 2 * sizeof(Vec2) + sizeof(Vec4));
}

std::uint64_t mesh_memory(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const auto& mesh : scene.meshes)
        bytes += vertex_bytes(mesh->positions.size()) +
                 mesh->triangles.size() * (sizeof(Triangle) + 3 * sizeof(Vec2) + 2 * sizeof(std::uint32_t));
    return bytes;
}

// As they are traced: 8-bit RGBA.
std::uint64_t texture_memory(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const Texture& texture : scene.textures) bytes += texture.rgba.size();
    return bytes;
}

// The file that was read: textures compressed, meshes about as they are in memory.
std::uint64_t document_memory(const Scene& scene) { return texture_memory(scene) / 2 + mesh_memory(scene); }

// scene.glb (with a copy of all that the document holds) and the manifest, one after the other, each as a tree of JSON.
std::uint64_t output_memory(const Scene& scene, const Atlas& atlas) {
    std::uint64_t glb = document_memory(scene) + picture_memory(atlas);
    for (const Instance& instance : scene.instances)
        glb += kGlbBytesPerInstance + scene.meshes[instance.mesh]->primitives.size() * kGlbBytesPerPrimitive;
    return std::max(glb, atlas.placements.size() * kManifestBytesPerChart);
}

}  // namespace

std::uint64_t scene_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas) {
    std::uint64_t bytes = kProgramBytes + texture_memory(scene) + mesh_memory(scene) + document_memory(scene);
    bytes += vertex_bytes(geometry.positions.size());
    bytes += geometry.triangles.size() * (sizeof(WorldTriangle) + kTracerBytesPerTriangle + kBakedTriangleBytes);
    bytes += atlas.placements.size() * kPlacementBytes;
    if (scene.sky.map) bytes += scene.sky.map->radiance.size() * (sizeof(Vec3) + 12);
    return bytes;
}

std::uint64_t page_memory(const AtlasPage& page, unsigned threads) {
    const std::uint64_t texels = pixels_of(page);
    const std::uint64_t rows = kRowsPerThread * threads * page.width * kMasterPixelBytes * kCopiesOfRows;
    // The texel buffer is gone when the files are written.
    return texels * (kSumsBytes + kLightmapBytes + kBytesPerPixel) + std::max(texels * kTexelBufferBytes, rows);
}

std::uint64_t bake_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas, unsigned threads) {
    std::uint64_t page = 0;
    for (const AtlasPage& p : atlas.pages) page = std::max(page, page_memory(p, threads));
    return scene_memory(scene, geometry, atlas) + preview_memory(atlas) + picture_memory(atlas) +
           std::max(page, output_memory(scene, atlas));
}

}  // namespace lumel
