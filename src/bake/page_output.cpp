#include "bake/page_output.h"

#include <algorithm>
#include <vector>

#include "bake/chart_options.h"
#include "bake/collapse.h"
#include "bake/stage_timer.h"
#include "base/try.h"
#include "chart/chart_picture.h"
#include "encode/irradiance.h"
#include "post/mip.h"

namespace lumel {
namespace {

// One after the other: each is made from the page itself.
Status write_mips(const PageOutput& out, const Atlas& atlas, const Lightmap& page) {
    const MaskRule& masks = atlas.masks;
    for (std::uint32_t mip = 1; mip <= masks.mips; ++mip) {
        const StageTimer timer(out.report, "mips");
        const std::vector<std::uint32_t> readers = chart_ids(out.scene, out.charts, atlas, page.page, mip);
        // Texels that hold a point of a chart have light: lookups reach one or two beyond.
        LUMEL_TRY(const Lightmap map, make_mip(page, mip, readers, masks.reach(), out.context));
        LUMEL_TRY_STATUS(out.sink.page(map));
    }
    return success();
}

// As the first time, with the density that it came to and no larger pages.
ChartOptions options_again(const BakeOptions& options, const Atlas& then, const std::vector<bool>& collapsed) {
    ChartOptions out = chart_options(options);
    out.texels_per_metre = then.density;
    out.atlas_bytes = 0;  // it is what the density was solved for
    out.sizes = collapsed_sizes(then, collapsed);
    if (options.max_memory_bytes == 0) return out;
    std::uint32_t longest = 64;
    for (const AtlasPage& page : then.pages) longest = std::max({longest, page.width, page.height});
    out.max_page = std::min(out.max_page, longest);
    return out;
}

}  // namespace

PageReport page_report(const Lightmap& map, std::size_t texels) {
    PageReport page;
    page.page = map.page;
    page.width = map.width;
    page.height = map.height;
    page.texels = texels;
    for (const Coverage coverage : map.coverage) {
        page.filled += coverage == Coverage::filled;
        page.dilated += coverage == Coverage::dilated;
    }
    for (std::size_t i = 0; i < texels; ++i) page.invalid += map.coverage[i] != Coverage::baked;
    page.coverage =
        static_cast<double>(page.texels - page.invalid) / static_cast<double>(std::uint64_t{page.width} * page.height);
    return page;
}

Status PageOutput::write(const Atlas& atlas, const Lightmap& page) const {
    if (!sink.page) return success();
    {
        const StageTimer timer(report, "write");
        LUMEL_TRY_STATUS(sink.page(page));
    }
    return write_mips(*this, atlas, page);
}

Status PageOutput::write_collapsed(std::span<const Lightmap> pages, Atlas& atlas) const {
    const Atlas then = atlas;
    std::vector<bool> collapsed;
    {
        const StageTimer timer(report, "collapse");
        const bool smooth = options.denoise.value_or(preset_values(options.preset).denoise);
        collapsed = even_charts(pages, then, {options.collapse, layer_weights(options.include), !smooth});
        report.collapsed_charts = static_cast<std::uint64_t>(std::ranges::count(collapsed, true));
        if (report.collapsed_charts > 0) {
            const Diagnostics before = context.diagnostics;  // all was said of the first layout
            LUMEL_TRY(atlas, make_atlas(scene, geometry, charts, options_again(options, then, collapsed), context));
            context.diagnostics = before;
        }
    }
    if (sink.layout) LUMEL_TRY_STATUS(sink.layout(geometry, charts, atlas));
    if (report.collapsed_charts == 0) {
        for (const Lightmap& page : pages) LUMEL_TRY_STATUS(write(atlas, page));
        return success();
    }
    report.pages.clear();
    const LayoutChange change(scene, charts, then, pages, atlas, collapsed);
    for (std::uint32_t p = 0; p < atlas.pages.size(); ++p) {
        LUMEL_TRY(const Lightmap page, change.page(p, options.dilate, context));
        const auto own = std::ranges::count_if(page.coverage, [](Coverage c) { return c >= Coverage::filled; });
        report.pages.push_back(page_report(page, static_cast<std::size_t>(own)));
        LUMEL_TRY_STATUS(write(atlas, page));
    }
    return success();
}

}  // namespace lumel
