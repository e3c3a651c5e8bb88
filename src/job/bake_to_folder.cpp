// bake_to_folder: bake(), its writer and its pictures.
#include "lumel/bake_folder.h"

#include <algorithm>

#include "bake/memory.h"
#include "bake/stage_timer.h"
#include "base/cancelled.h"
#include "base/try.h"
#include "io/bake_writer.h"
#include "job/views.h"

namespace lumel {
namespace {

// What a page took while it was baked is free by now. 0: no ceiling.
std::uint64_t memory_for_views(const BakeOptions& options, const BakeReport& report) {
    if (options.max_memory_bytes == 0) return 0;
    std::uint64_t most = 0;
    for (const PageReport& page : report.pages)
        most = std::max(
            most, page_memory({page.width, page.height}, options.mips.value_or(0), options.seams, report.threads));
    return most;
}

}  // namespace

Result<BakeReport> bake_to_folder(const LoadedScene& loaded, const BakeOptions& options,
                                  const std::filesystem::path& output, const FolderOptions& folder, Context& context) {
    LUMEL_TRY(BakeWriter writer, BakeWriter::create(output, loaded, options, context));
    if (folder.begun) folder.begun(writer.folder());
    BakeSink sink;
    sink.layout = [&](const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas) {
        return writer.layout(geometry, charts, atlas);
    };
    sink.page = [&](const Lightmap& page) -> Status {
        LUMEL_TRY_STATUS(writer.page(page));
        return folder.page ? folder.page(read_pixels(page, options.include)) : success();
    };
    sink.finished = [&](const Transport& transport, BakeReport& report) -> Status {
        {
            const StageTimer timer(report, "scene");
            LUMEL_TRY_STATUS(writer.write_scene());
        }
        const StageTimer timer(report, "views");
        return write_views(writer, transport, options,
                           {folder.views, folder.view_samples, memory_for_views(options, report)}, context);
    };
    LUMEL_TRY(BakeReport report, bake(loaded.scene, options, sink, context));
    LUMEL_TRY_STATUS(writer.finish(report, context.diagnostics));
    if (folder.may_appear && !folder.may_appear()) return cancelled_error();
    LUMEL_TRY_STATUS(writer.commit());
    return report;
}

}  // namespace lumel
