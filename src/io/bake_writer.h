// Writes the output folder while the bake runs: each page's files as soon as the page is done, then the scene, then
// what sums up. Of a page only small previews and the compressed picture for scene.glb stay in memory.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "chart/chart_set.h"
#include "io/gltf_document.h"
#include "lumel/bake.h"
#include "post/lightmap.h"
#include "scene/world_geometry.h"

namespace lumel {

class BakeWriter {
public:
    // Makes the partial folder beside `output` (see output_folder.h): errors of permission show here. Borrows `loaded`
    // and `context` (for threads, progress and cancelling) for its lifetime.
    static Result<BakeWriter> create(const std::filesystem::path& output, const LoadedScene& loaded,
                                     const BakeOptions& options, Context& context);
    ~BakeWriter();  // without commit() nothing is left behind
    BakeWriter(BakeWriter&&) noexcept;
    BakeWriter& operator=(BakeWriter&&) noexcept;

    // What BakeSink wants. Keeps copies of charts and atlas.
    Status layout(const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas);
    Status page(const Lightmap& lightmap);

    // After the last page: scene.glb.
    Status write_scene();

    // Previews over all pages, manifest, and at last the report: its peak_memory_bytes becomes that of all there was to
    // do but to write the few kilobytes of the report itself.
    Status finish(BakeReport& report, const Diagnostics& diagnostics);

    // The folder appears.
    Status commit();

    // preview_view_<k>.png: 8-bit RGB.
    Status write_view(std::size_t k, std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb);

    // Where files are until commit().
    [[nodiscard]] const std::filesystem::path& folder() const;

private:
    struct Impl;
    // Errors as the user knows them: files by their place in the output folder; of a full disk, how much was needed.
    [[nodiscard]] Status explain(Status status) const;
    explicit BakeWriter(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace lumel
