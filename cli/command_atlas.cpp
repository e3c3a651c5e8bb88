// lumel atlas: charts and where they lie, without light; figures and pictures of how good the layout is.
#include <cstdio>

#include "bake/chart_options.h"
#include "base/cancelled.h"
#include "base/try.h"
#include "command.h"
#include "interrupt.h"
#include "io/atlas_writer.h"
#include "io/gltf_document.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string scene, output, progress;
    std::uint32_t threads = 0;
    TexelOptions texels;
};

void print_summary(const AtlasStatistics& s, const Atlas& atlas, const std::string& folder) {
    std::printf("%s: %llu charts on %zu page%s, %llu texels of %llu used (%.2f %%), %llu covered\n", folder.c_str(),
                static_cast<unsigned long long>(s.charts), atlas.pages.size(), atlas.pages.size() == 1 ? "" : "s",
                static_cast<unsigned long long>(s.used), static_cast<unsigned long long>(s.page_texels),
                100.0 * s.efficiency, static_cast<unsigned long long>(s.covered));
    std::printf("%.2f texels/m on average, L2 stretch %.4f (1: lengths on the page are true)\n", s.mean_density,
                s.stretch);
    std::printf("layout: %s\npictures: %s (charts, waste, density, stretch)\n",
                (std::filesystem::path(folder) / kAtlasFile).c_str(),
                (std::filesystem::path(folder) / "atlas_*.png").c_str());
}

Status run(const Options& options) {
    RunContext run_context(options.threads, options.progress);
    Context& context = run_context.get();
    BakeOptions bake_options;
    LUMEL_TRY_STATUS(options.texels.read(bake_options));
    const ChartOptions chart = chart_options(bake_options);
    LUMEL_TRY(const LoadedScene loaded, load_scene(options.scene, context));
    LUMEL_TRY(AtlasWriter writer, AtlasWriter::create(options.output));
    run_context.interrupt().set_cleaner(writer.cleaner());
    const Scene& scene = loaded.scene;
    LUMEL_TRY(const WorldGeometry geometry, flatten(scene, context));
    LUMEL_TRY(const ChartSet charts, make_charts(scene, geometry, chart, context));
    LUMEL_TRY(const Atlas atlas, make_atlas(scene, geometry, charts, chart, context));
    if (atlas.pages.empty())
        return Error{ErrorCode::invalid_input, "no surface of the scene gets lightmap texels", scene.source,
                     "lumel info lists the class of every node"};
    LUMEL_TRY(const AtlasStatistics statistics, writer.write(scene, geometry, charts, atlas, context));
    if (!run_context.interrupt().begin_commit()) return cancelled_error();
    LUMEL_TRY_STATUS(writer.commit());
    run_context.finish();
    print_summary(statistics, atlas, options.output);
    if (bake_options.atlas) print_kept(atlas.kept, atlas.placements.size(), *bake_options.atlas);
    return success();
}

}  // namespace

Run add_atlas(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("SCENE", options->scene, "glTF scene: .glb or .gltf")->required();
    app.add_option("-o,--output", options->output, "Folder for atlas.json and its pictures")
        ->required()
        ->check(not_empty());
    options->texels.declare(app);
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    declare_progress(app, options->progress);
    return [options] {
        const Status status = run(*options);
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "atlas");
    };
}

}  // namespace lumel::cli
