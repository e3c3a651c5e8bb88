#include "bake/memory.h"

#include <algorithm>
#include <cmath>

#include "encode/output_sizes.h"
#include "light/emissive.h"
#include "path/light_cells.h"
#include "path/radiance_sums.h"
#include "seam/seam_samples.h"

namespace lumel {
namespace {

// Measured with Embree 3.13 at build quality high, at the peak of the build: 111 bytes a triangle for Sponza (262,000),
// 112 for a rolling field and 116 for a cloud of small triangles (500,000 each). Our list of triangles comes on top,
// and a copy of the positions.
constexpr std::uint64_t kTracerBytesPerTriangle = 130, kTracerBytesPerVertex = sizeof(Vec3);
// Of an emissive triangle: two nodes of the light tree, and what they are made of; its place among the lights.
constexpr std::uint64_t kLightBytesPerTriangle = 2 * 100 + sizeof(LightBounds) + 12;
constexpr std::uint64_t kProgramBytes = 64u << 20;  // code, libraries, allocator slack

// One texel of a page that is covered all over, which is the most there is: dilated texels take no more than covered
// ones, and the sums have room for them from the start, so that no array is held twice while it grows.
constexpr std::uint64_t kSumsBytes =
    kLayerCount * sizeof(LayerMoments) + 3 * sizeof(Vec3) + 2 * sizeof(float) + 2 * sizeof(std::uint32_t);
// x, y, valid points, owner, position, normal, size; start and share of the triangle lists; its place in the blocks.
constexpr std::uint64_t kTexelBufferBytes = 4 + 8 + 4 + 2 * sizeof(Vec3) + 4 + 4 + 12 + 8;
// Albedo, emission, normal, coverage, leaks, chart; queue of the fill or guides of the denoiser or pooled variance or
// equations of the fit (nine shares and six numbers each), of which one lives at a time.
constexpr std::uint64_t kLightmapBytes = 3 * sizeof(Vec3) + 2 + 4 + 15 * sizeof(float);
// Of a thread: a block of texels with their points and sums, a wavefront of paths.
constexpr std::uint64_t kWorkspaceBytes = 1u << 20;
// Seams. Measured at 0.25 M texels, most of them rims: 0.06 to 0.09 samples for each texel (city, Sponza, Doom map) and
// 0.07 texels at seams (city); twice these is assumed of the latter. Where texels are few, each seam still has a
// sample.
constexpr double kSeamSamplesPerTexel = 0.1, kSeamTexelsPerTexel = 0.15, kSeamSamplesPerEdge = 0.5;
// Of a texel of the page while its seams are solved for: the equation of a sample takes 80 bytes, twice while the list
// grows, and its residuals 32 on each of up to four threads; a texel at a seam takes 360 as it was, 36 of weights, and
// four times 32 on each of four threads; each texel its place among them. None of the texel buffer's workspace is in
// use then.
constexpr auto kSeamBytes = static_cast<std::uint64_t>(kSeamSamplesPerTexel * (2 * 80 + 4 * 32) +
                                                       kSeamTexelsPerTexel * (360 + 36 + 4 * 128) + 4);
// Of an edge while seams are looked for: itself, twice while the list grows, its line, its box and node, and what it is
// found to be a seam with, in parts and in one list.
constexpr std::uint64_t kBytesPerBorderEdge = 2 * sizeof(BorderEdge) + 56 + 24 + 4 + 36 + 2 * sizeof(Seam);
// Of a sample for later pages: what the earlier one showed.
constexpr std::uint64_t kRememberedBytes = kLayerCount * sizeof(LayerMoments) + sizeof(std::uint32_t);
constexpr std::uint64_t kBytesPerPixel = 3 * sizeof(std::uint32_t);  // texel_at of both, readers

// Rows of the master, the widest file, on one thread: as they were filled, as OpenEXR packs them, room to sort the
// bytes in, room for what comes out (which may be larger: 1.3 times), and what came out.
constexpr std::uint64_t kMasterPixelBytes = sizeof(float) * (kLayerCount * (3 * kShCoefficients + 3) + 8);
constexpr std::uint64_t kCopiesOfRows = 6;

// Of a page, once it is written, there stay: previews, and the picture for scene.glb, which noise does not let compress
// by much.
constexpr std::uint64_t kPictureBytes = 3;

// Of cells: site, side, use; texel_at of their pages. And their UVs of each triangle.
constexpr std::uint64_t kCellBytes = 32, kCellBytesPerTriangle = 3 * sizeof(Vec2) + 2 * sizeof(std::uint32_t);
constexpr std::uint64_t kLeastCellsPerChart = 4;

// The atlases of the bake, of the cells and of what is displayed, and packing.
constexpr std::uint64_t kPlacementBytes = 3 * sizeof(ChartPlacement) + 32;
// Trees of JSON. Measured on a town of 20,000 instances of one primitive and 21 charts each: about 5,500 bytes an
// instance in scene.glb, 110 a chart in the manifest.
constexpr std::uint64_t kGlbBytesPerInstance = 4000, kGlbBytesPerPrimitive = 4000;
constexpr std::uint64_t kManifestBytesPerChart = 200;
constexpr std::uint64_t kBakedTriangleBytes = 28;  // of the views

std::uint64_t pixels_of(const AtlasPage& page) { return std::uint64_t{page.width} * page.height; }

std::uint64_t preview_pixels(const AtlasPage& page) {
    const std::uint64_t block = preview_block(page.width, page.height, kPreviewEdge);
    return pixels_of(page) / (block * block);
}

std::uint64_t picture_memory(const Atlas& atlas) {
    std::uint64_t bytes = 0;
    for (const AtlasPage& page : atlas.pages) bytes += pixels_of(page) * kPictureBytes;
    return bytes;
}

std::uint64_t preview_memory(const Atlas& atlas) {
    std::uint64_t bytes = 0;
    for (const AtlasPage& page : atlas.pages) bytes += preview_pixels(page) * kPreviewPixelBytes;
    return bytes;
}

// Of a mesh or of the world: attributes that a file has none of take nothing.
template <class Vertices>
std::uint64_t vertex_bytes(const Vertices& v) {
    return (v.positions.size() + v.normals.size()) * sizeof(Vec3) + (v.uv0.size() + v.uv1.size()) * sizeof(Vec2) +
           v.colors.size() * sizeof(Vec4);
}

std::uint64_t mesh_memory(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const auto& mesh : scene.meshes)
        bytes += vertex_bytes(*mesh) +
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

std::uint64_t tracer_memory(const WorldGeometry& geometry) {
    return geometry.triangles.size() * kTracerBytesPerTriangle + geometry.positions.size() * kTracerBytesPerVertex;
}

std::uint64_t light_memory(const WorldGeometry& geometry) {
    const auto emitters = static_cast<std::uint64_t>(std::ranges::count_if(geometry.triangles, is_emitter));
    if (emitters == 0) return 0;
    // With one emitter there is a list of which light each triangle is.
    return emitters * kLightBytesPerTriangle + geometry.triangles.size() * sizeof(std::uint32_t);
}

std::uint64_t scene_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas) {
    std::uint64_t bytes = kProgramBytes + texture_memory(scene) + mesh_memory(scene) + document_memory(scene);
    bytes += vertex_bytes(geometry) + tracer_memory(geometry) + light_memory(geometry);
    bytes += geometry.triangles.size() * (sizeof(WorldTriangle) + kBakedTriangleBytes);
    bytes += atlas.placements.size() * kPlacementBytes;
    if (scene.sky.map) bytes += scene.sky.map->radiance.size() * (sizeof(Vec3) + 12);
    return bytes;
}

std::uint64_t page_memory(const AtlasPage& page, std::uint32_t mips, bool seams, unsigned threads) {
    const std::uint64_t texels = pixels_of(page);
    const std::uint64_t mip = mips == 0 ? 0 : texels / 4 * (kSumsBytes + kLightmapBytes + kBytesPerPixel);
    const std::uint64_t rows =
        std::uint64_t{kExrRowsPerChunk} * threads * page.width * kMasterPixelBytes * kCopiesOfRows;
    // The texel buffer is gone when the files are written, and so is what each thread traces with.
    return texels * (kSumsBytes + kLightmapBytes + (seams ? kSeamBytes : 0) + kBytesPerPixel) +
           std::max(texels * kTexelBufferBytes + threads * kWorkspaceBytes, mip + rows);
}

CellMemory cell_memory(const WorldGeometry& geometry, const Atlas& atlas, std::uint32_t samples) {
    const double edge = texels_per_cell(atlas, samples);
    std::uint64_t pixels = 0;
    for (const AtlasPage& page : atlas.pages) pixels += pixels_of(page);
    const auto covered = static_cast<std::uint64_t>(static_cast<double>(pixels) / (edge * edge));
    // A chart n cells across has (n + 1)^2: the rim adds at most what charts of equal size would have.
    const auto charts = static_cast<double>(atlas.placements.size());
    const auto rims = static_cast<std::uint64_t>(2.0 * std::sqrt(static_cast<double>(covered) * charts));
    std::uint64_t cells = covered + rims + kLeastCellsPerChart * atlas.placements.size();
    const bool both_sides = std::ranges::any_of(
        geometry.triangles, [](const WorldTriangle& triangle) { return (triangle.flags & kDoubleSided) != 0; });
    const std::uint64_t fronts = cells;
    if (both_sides) cells *= 2;
    return {fronts * kCellBytes + cells * 2 * sizeof(Vec3) + geometry.triangles.size() * kCellBytesPerTriangle,
            fronts * kTexelBufferBytes +
                cells * (links_per_cell(cells, samples) * sizeof(CellLink) + sizeof(CellGather) + 6 * sizeof(Vec3))};
}

SeamMemory seam_memory(std::uint64_t border_edges, const Atlas& atlas) {
    std::uint64_t pixels = 0;
    for (const AtlasPage& page : atlas.pages) pixels += pixels_of(page);
    const auto samples = static_cast<std::uint64_t>(kSeamSamplesPerTexel * static_cast<double>(pixels) +
                                                    kSeamSamplesPerEdge * static_cast<double>(border_edges));
    // Once more in parts, or while they are sorted.
    return {samples * (sizeof(SeamSample) + (atlas.pages.size() > 1 ? kRememberedBytes : 0)),
            border_edges * kBytesPerBorderEdge + samples * sizeof(SeamSample)};
}

std::uint64_t bake_memory(const Scene& scene, const WorldGeometry& geometry, const Atlas& atlas, const MemoryPlan& plan,
                          unsigned threads) {
    const bool with_seams = plan.border_edges.has_value();
    std::uint64_t page = 0, kept = 0;
    for (const AtlasPage& p : atlas.pages) page = std::max(page, page_memory(p, atlas.masks.mips, with_seams, threads));
    CellMemory cells;
    if (plan.cell_samples > 0) cells = cell_memory(geometry, atlas, plan.cell_samples);
    if (plan.keeps_pages)
        for (const AtlasPage& p : atlas.pages) kept += pixels_of(p) * (kSumsBytes + kLightmapBytes + kBytesPerPixel);
    SeamMemory seams;
    if (with_seams) seams = seam_memory(*plan.border_edges, atlas);
    return kept + scene_memory(scene, geometry, atlas) + preview_memory(atlas) + picture_memory(atlas) + cells.cells +
           std::max({seams.samples + page, seams.samples + seams.finding, cells.links, output_memory(scene, atlas)});
}

}  // namespace lumel
