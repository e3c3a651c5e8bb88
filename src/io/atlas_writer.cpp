#include "io/atlas_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/try.h"
#include "encode/output_sizes.h"
#include "image/colormap.h"
#include "io/baked.h"
#include "io/image_io.h"
#include "io/json_write.h"
#include "io/layout_json.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kPictureEdge = 4096;
// Heat from blue to yellow: a quarter to four times the mean density; no stretch to twice.
constexpr double kDensityOctaves = 2.0, kMostStretch = 2.0;
constexpr std::array<const char*, 4> kPictures{"charts", "waste", "density", "stretch"};

constexpr Vec3 kFreeColor{0.86f, 0.16f, 0.16f}, kBorderColor{0.96f, 0.76f, 0.22f}, kCoveredColor{0.24f, 0.29f, 0.36f};

std::string picture_stem(const char* what) { return std::string("atlas_") + what + "_"; }
std::string picture_file(const char* what, std::uint32_t page) {
    return picture_stem(what) + std::to_string(page) + ".png";
}

bool is_picture_file(const std::string& name) {
    return std::ranges::any_of(kPictures,
                               [&](const char* what) { return is_numbered(name, picture_stem(what), ".png"); });
}

// What is drawn: all pages in one scale.
struct Drawing {
    const WorldGeometry& geometry;
    const Scene& scene;
    const ChartSet& charts;
    const Atlas& atlas;
    std::vector<double> density;               // per triangle of the world
    std::vector<std::vector<double>> stretch;  // per mesh and triangle
    double mean = 0.0;                         // density

    [[nodiscard]] Vec3 color(std::size_t picture, std::uint32_t triangle, bool covered) const {
        if (picture == 1) return triangle == kNone ? kFreeColor : covered ? kCoveredColor : kBorderColor;
        if (triangle == kNone) return {};
        const WorldTriangle& t = geometry.triangles[triangle];
        const std::uint32_t mesh = scene.instances[t.instance].mesh;
        if (picture == 0)
            return identity_color(atlas.first_placement[t.instance] +
                                  charts.meshes[mesh].chart_of_triangle[t.mesh_triangle]);
        if (picture == 2) {
            const double octaves = density[triangle] > 0.0 ? std::log2(density[triangle] / mean) : -kDensityOctaves;
            return heat_color(static_cast<float>(0.5 + 0.5 * octaves / kDensityOctaves));
        }
        return heat_color(static_cast<float>((stretch[mesh][t.mesh_triangle] - 1.0) / (kMostStretch - 1.0)));
    }
};

Status write_picture(const fs::path& path, std::size_t picture, const Drawing& drawing, const AtlasPage& page,
                     const TexelOwners& owners) {
    const std::uint32_t block = preview_block(page.width, page.height, kPictureEdge);
    const std::uint32_t width = (page.width + block - 1) / block, height = (page.height + block - 1) / block;
    std::vector<std::uint8_t> rgb;
    rgb.reserve(std::size_t{3} * width * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::size_t texel = std::size_t{y} * block * page.width + std::size_t{x} * block;
            const Vec3 color = drawing.color(picture, owners.triangle[texel], owners.covered[texel] != 0);
            for (std::size_t c = 0; c < 3; ++c)
                rgb.push_back(static_cast<std::uint8_t>(std::clamp(color[c], 0.0f, 1.0f) * 255.0f + 0.5f));
        }
    return write_png(path, width, height, 3, rgb);
}

// JSON has no infinity.

Json mips_json(const std::vector<MipFigures>& mips) {
    Json out = Json::array();
    for (const MipFigures& mip : mips)
        out.push_back({{"used", mip.used}, {"texels", mip.texels}, {"efficiency", mip.efficiency()}});
    return out;
}

Json page_json(std::uint32_t index, const AtlasPage& page, const PageFigures& figures,
               const std::vector<MipFigures>& mips) {
    Json files = Json::object();
    for (const char* what : kPictures) files[what] = picture_file(what, index);
    return {{"index", index},          {"width", page.width},        {"height", page.height},
            {"used", figures.used},    {"covered", figures.covered}, {"efficiency", figures.efficiency},
            {"mips", mips_json(mips)}, {"files", std::move(files)}};
}

Json statistics_json(const AtlasStatistics& s, const Atlas& atlas) {
    return {{"charts", s.charts},
            {"kept", atlas.kept},
            {"used", s.used},
            {"covered", s.covered},
            {"page_texels", s.page_texels},
            {"efficiency", s.efficiency},
            {"mips", mips_json(s.mips)},
            {"mean_density", s.mean_density},
            {"texels_per_metre", atlas.texels_per_metre},
            {"least_texels_per_metre", atlas.least_texels_per_metre},
            {"stretch", finite_or_null(s.stretch)}};
}

}  // namespace

Result<AtlasWriter> AtlasWriter::create(const fs::path& folder) {
    // As manifest.json does, atlas.json says near its beginning who wrote it.
    LUMEL_TRY(FileSet files, FileSet::create(folder, {"atlas", "atlas", "\"Lumel\"", is_picture_file}));
    return AtlasWriter(std::move(files));
}

Result<AtlasStatistics> AtlasWriter::write(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                           const Atlas& atlas, Context& context) {
    Drawing drawing{geometry,
                    scene,
                    charts,
                    atlas,
                    triangle_densities(scene, geometry, charts, atlas),
                    triangle_stretches(scene, charts)};
    drawing.mean = mean_density(geometry, drawing.density);
    AtlasStatistics statistics;
    statistics.mean_density = drawing.mean;
    statistics.stretch = layout_stretch(scene, geometry, charts);
    for (const ChartPlacement& place : atlas.placements) statistics.charts += place.page != kNone ? 1 : 0;
    Json pages = Json::array();
    for (std::uint32_t p = 0; p < atlas.pages.size(); ++p) {
        const AtlasPage& page = atlas.pages[p];
        const TexelOwners owners = texel_owners(scene, geometry, charts, atlas, p);
        const PageFigures figures = page_figures(owners);
        const std::vector<MipFigures> mips = mip_figures(scene, charts, atlas, p);
        statistics.mips.resize(mips.size());
        for (std::size_t k = 0; k < mips.size(); ++k) {
            statistics.mips[k].used += mips[k].used;
            statistics.mips[k].texels += mips[k].texels;
        }
        pages.push_back(page_json(p, page, figures, mips));
        statistics.used += figures.used;
        statistics.covered += figures.covered;
        statistics.page_texels += owners.triangle.size();
        std::array<Status, kPictures.size()> written{success(), success(), success(), success()};
        const bool done = parallel_for(context, kPictures.size(), 1, [&](const ChunkRange& range) {
            const fs::path path = partial() / picture_file(kPictures[range.begin], p);
            written[range.begin] = write_picture(path, range.begin, drawing, page, owners);
        });
        if (!done) return cancelled_error();
        for (const Status& status : written)
            if (!status.ok()) return files_.in_place(status.error());
        context.report("pictures", static_cast<double>(p + 1) / static_cast<double>(atlas.pages.size()));
    }
    if (statistics.page_texels > 0)
        statistics.efficiency = static_cast<double>(statistics.used) / static_cast<double>(statistics.page_texels);
    const Json json{{"version", 1},
                    {"generator", "Lumel"},
                    {"source", fs::path(scene.source).filename().string()},
                    {"geometry_hash", hash_geometry(geometry)},
                    {"density", atlas.density},
                    {"scene_wide_uvs", charts.scene_wide},
                    {"lookups", lookups_json(atlas.masks)},
                    {"statistics", statistics_json(statistics, atlas)},
                    {"pages", std::move(pages)},
                    {"instances", instances_json(scene, charts, atlas)},
                    {"charts", charts_json(scene, charts, atlas)}};
    const Status status = write_with_long_arrays(partial() / kAtlasFile, json, {"charts", "instances"});
    if (!status.ok()) return files_.in_place(status.error());
    return statistics;
}

Status AtlasWriter::commit() { return files_.commit(); }

}  // namespace lumel
