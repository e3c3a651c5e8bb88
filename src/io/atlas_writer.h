// The files of `lumel atlas`: a layout without light, and pictures of how good it is. Format: docs/formats.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "chart/chart_set.h"
#include "chart/layout_figures.h"
#include "io/file_set.h"
#include "io/gltf_document.h"
#include "lumel/context.h"
#include "scene/world_geometry.h"

namespace lumel {

inline constexpr const char* kAtlasFile = "atlas.json";

// Over all pages.
struct AtlasStatistics {
    std::uint64_t charts = 0;             // placed
    std::uint64_t used = 0, covered = 0;  // texels that lookups touch; of these, those that a bake would trace
    std::uint64_t page_texels = 0;
    double efficiency = 0.0;       // used over page_texels
    std::vector<MipFigures> mips;  // of the declared ones, that of the pages themselves first
    double mean_density = 0.0;     // texels per metre: root of texels over square metres
    double stretch = 1.0;          // Sander's L2 of the charts
};

class AtlasWriter {
public:
    // Errors: io, where the folder cannot be written to or files of these names that no atlas wrote would be replaced.
    static Result<AtlasWriter> create(const std::filesystem::path& folder);

    // FileSet::cleaner.
    [[nodiscard]] std::function<void()> cleaner() const { return files_.cleaner(); }

    // Pictures of all pages and atlas.json. Errors: io; cancelled.
    Result<AtlasStatistics> write(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                  const Atlas& atlas, Context& context);
    // All of it appears.
    Status commit();

private:
    explicit AtlasWriter(FileSet files) : files_(std::move(files)) {}
    [[nodiscard]] const std::filesystem::path& partial() const { return files_.partial(); }

    FileSet files_;
};

}  // namespace lumel
