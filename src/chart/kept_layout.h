// A scene-wide TEXCOORD_1 layout that is kept as it is: its page and what its charts do to each other there.
#pragma once

#include "chart/chart_set.h"

namespace lumel {

// The page: that of the layout to keep, else of the asked resolution, else square, its edge such that the mean density
// (over area) or the texel budget is met; a multiple of 4 within max_page.
AtlasPage kept_page(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                    const ChartOptions& options);

// Two charts of a kept layout that share texels of the page: a bilinear lookup in either reads them.
struct ChartContact {
    struct Side {
        std::uint32_t instance = 0, chart = 0;
        std::uint32_t triangle = 0;  // of the mesh, at `texel_x`, `texel_y`
    };
    Side a, b;
    std::uint64_t texels = 0;   // shared
    std::uint64_t foreign = 0;  // of them, those where the two are not one smooth surface: their light differs
    std::uint32_t texel_x = 0, texel_y = 0;  // the first foreign one, or the first
};

// In the order of the charts. Of three charts at a texel the first one meets both others.
std::vector<ChartContact> find_contacts(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                        AtlasPage page);

// Charts of one node that meet become one chart, as one texel has one owner. Between nodes the first keeps the texel.
void merge_contacts(const Scene& scene, const std::vector<ChartContact>& contacts, ChartSet& charts);

// Diagnostic "uv-bleeding": the pairs with foreign texels, those with most of them first.
void report_bleeding(const Scene& scene, std::vector<ChartContact> contacts, AtlasPage page, Diagnostics& diagnostics);

}  // namespace lumel
