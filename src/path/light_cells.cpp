#include "path/light_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/progress_parts.h"
#include "base/try.h"

namespace lumel {
namespace {

// Time that it takes to make cells and to solve them, in that of a path that a cell gathers.
constexpr double kMakeWork = 3.0, kSolveWork = 1.0;

}  // namespace

double texels_per_cell(const Atlas& atlas, std::uint32_t samples) {
    constexpr double kTexelsPerCell = 2.8, kSamplesOfThat = 256.0, kMostTexelsPerCell = 8.0;
    double texels = 0.0;
    for (const AtlasPage& page : atlas.pages) texels += static_cast<double>(page.width) * page.height;
    const double by_noise =
        std::clamp(kTexelsPerCell * std::sqrt(kSamplesOfThat / static_cast<double>(samples)), 1.0, kMostTexelsPerCell);
    return std::max(by_noise, std::sqrt(texels / kMostCells));
}

Result<SurfaceCells> make_lit_cells(const ChartSet& charts, const Atlas& atlas, const Transport& transport,
                                    const PathOptions& path, Context& context) {
    LUMEL_CHECK(path.bounces > 0 && !transport.cells, path.bounces);
    const double gather_work = path.samples;
    ProgressParts progress(context, "cells", kMakeWork + gather_work + kSolveWork);
    progress.begin(kMakeWork);
    LUMEL_TRY(SurfaceCells cells, SurfaceCells::make(transport.scene, transport.geometry, charts, atlas,
                                                     transport.tracer, texels_per_cell(atlas, path.samples), context));
    if (cells.size() == 0) {
        progress.begin(gather_work + kSolveWork);
        context.report("cells", 1.0);
        return cells;
    }

    Transport into_cells = transport;
    into_cells.cells = &cells;
    PathOptions gathering = path;
    gathering.seed = ~path.seed;           // not the paths of the texels
    gathering.bounces = path.bounces - 1;  // of which a texel's path that ends at the cell was one
    const PathIntegrator integrator(into_cells, gathering);
    std::vector<PathIntegrator::WorkspacePtr> workspaces(context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();
    const std::size_t links_each = links_per_cell(cells.size(), path.samples);
    std::vector<CellLink> links(cells.size() * links_each);
    std::vector<CellGather> gathers(cells.size());
    const std::uint64_t rays_before = transport.tracer.statistics().rays;
    progress.begin(gather_work);
    const bool done = parallel_for(
        context, cells.size(), 16,
        [&](const ChunkRange& range) {
            std::array<SamplePoint, kSamplesPerTexel> points;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const auto cell = static_cast<std::uint32_t>(i);
                const std::uint32_t n = cells.sample_points(cell, transport.scene, transport.geometry, charts, points);
                if (n == 0) continue;
                integrator.gather_cell({std::span(points).first(n), cell, cells.edge(cell)}, cells.is_back(cell),
                                       *workspaces[range.worker], gathers[i],
                                       std::span(links).subspan(i * links_each, links_each));
            }
        },
        "cells", [&] { return transport.tracer.statistics().rays - rays_before; });
    if (!done) return cancelled_error();
    progress.begin(kSolveWork);
    LUMEL_TRY_STATUS(cells.solve(gathers, links, path.bounces, context));
    cells.drop_sites();
    return cells;
}

}  // namespace lumel
