// Writes the output folder while the bake runs: each page's files as soon as the page is done, then the scene, then
// what sums up. Of a page only small previews and the compressed picture for scene.glb stay in memory.
#pragma once

#include <filesystem>
#include <memory>

#include "chart/chart_set.h"
#include "io/gltf_document.h"
#include "lumel/bake.h"
#include "post/lightmap.h"
#include "scene/world_geometry.h"

namespace lumel {

class BakeWriter {
public:
    // Makes the partial folder beside `output` (see output_folder.h): errors of permission show here. Borrows `loaded`
    // and `context` (which may cancel the writing) for its lifetime.
    static Result<BakeWriter> create(const std::filesystem::path& output, const LoadedScene& loaded,
                                     const BakeOptions& options, const Context& context);
    ~BakeWriter();  // without commit() nothing is left behind
    BakeWriter(BakeWriter&&) noexcept;
    BakeWriter& operator=(BakeWriter&&) noexcept;

    // What BakeSink wants. Keeps copies of charts and atlas.
    Status layout(const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas);
    Status page(const Lightmap& lightmap);

    // After the last page: scene.glb.
    Status write_scene();

    // Previews over all pages, manifest, report.
    Status finish(const BakeReport& report, const Diagnostics& diagnostics);

    // The folder appears.
    Status commit();

    // Where files are until commit(); further ones (preview_view_<k>.png) may be put there.
    [[nodiscard]] const std::filesystem::path& folder() const;

private:
    struct Impl;
    explicit BakeWriter(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace lumel
