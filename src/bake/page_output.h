// Where finished pages go: to the sink, each with its mips; and packed anew before that, where even charts collapse.
#pragma once

#include <cstddef>
#include <span>

#include "chart/chart_set.h"
#include "lumel/bake.h"
#include "post/lightmap.h"

namespace lumel {

// `texels`: those that were rasterised, which are the first of the page.
PageReport page_report(const Lightmap& map, std::size_t texels);

struct PageOutput {
    const Scene& scene;
    const WorldGeometry& geometry;
    const ChartSet& charts;
    const BakeOptions& options;
    const BakeSink& sink;
    BakeReport& report;
    Context& context;

    // The page and its mips, one after the other.
    [[nodiscard]] Status write(const Atlas& atlas, const Lightmap& page) const;

    // All pages of a bake at once: even charts collapse (collapse.h), the layout becomes `atlas`, and the sink gets
    // that and the new pages. Says in the report how many charts, and what pages there are.
    [[nodiscard]] Status write_collapsed(std::span<const Lightmap> pages, Atlas& atlas) const;
};

}  // namespace lumel
