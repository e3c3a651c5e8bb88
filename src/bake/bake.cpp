// The order of the stages. Nothing else knows it.
#include "lumel/bake.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "bake/chart_options.h"
#include "bake/inside_out.h"
#include "bake/memory.h"
#include "bake/page_output.h"
#include "bake/sample_plan.h"
#include "bake/stage_timer.h"
#include "base/denormals.h"
#include "base/memory_use.h"
#include "base/progress_parts.h"
#include "base/stopwatch.h"
#include "base/try.h"
#include "chart/chart_picture.h"
#include "chart/chart_set.h"
#include "light/light_set.h"
#include "math/normal_quantile.h"
#include "path/cell_bias.h"
#include "path/cell_noise.h"
#include "path/gather_page.h"
#include "path/light_cells.h"
#include "path/mip_leaks.h"
#include "path/path_integrator.h"
#include "path/pooled_variance.h"
#include "path/sealed_charts.h"
#include "post/denoise.h"
#include "post/fit_lookup.h"
#include "post/lightmap.h"
#include "scene/world_geometry.h"
#include "seam/blend_seams.h"
#include "seam/border_edges.h"
#include "texel/texel_buffer.h"
#include "trace/tracer.h"

namespace lumel {
namespace {

// Texels that are shared out where no density is asked: those of the one page, or those that bytes or the preset allow.
double texel_budget(const BakeOptions& options) {
    if (options.resolution_width == 0) return chart_options(options).texel_budget;
    return static_cast<double>(options.resolution_width) * options.resolution_height;
}

PathOptions path_options(const BakeOptions& options, const WorldGeometry& geometry) {
    PathOptions out = transport_options(options);
    out.samples = sample_budget(options);
    const float diagonal = length(geometry.bounds_max - geometry.bounds_min);
    out.ao_distance = options.ao_distance > 0.0 ? static_cast<float>(options.ao_distance) : 0.1f * diagonal;
    out.two_sided = options.two_sided;
    out.stop = options.stop;
    out.relative_error_of_mean = options.error / normal_quantile(0.5 + 0.5 * options.confidence);
    return out;
}

constexpr std::uint32_t kSmallestPage = 256;

// The largest page edge, of halves of `edge`, whose full page would fit; at least the smallest.
std::uint32_t edge_that_fits(std::uint32_t edge, std::uint32_t mips, bool seams, std::uint64_t memory,
                             unsigned threads) {
    while (edge > kSmallestPage && page_memory({edge, edge}, mips, seams, threads) > memory) edge /= 2;
    return std::max(edge, kSmallestPage);
}

// Packs the charts so that everything fits the memory allowed. Pages shrink by halves.
Result<Atlas> make_atlas_within_memory(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                       ChartOptions options, std::uint32_t cell_samples, bool seams, bool collapses,
                                       std::uint64_t max_memory, BakeReport& report, Context& context) {
    std::optional<std::uint64_t> border_edges;
    if (seams) border_edges = count_border_edges(scene, charts);
    const bool one_page = charts.scene_wide || options.resolution_width != 0, is_kept = options.previous != nullptr;
    const Diagnostics before = context.diagnostics;
    for (;;) {
        context.diagnostics = before;  // what a layout that is given up had to say is of no interest
        Result<Atlas> made = make_atlas(scene, geometry, charts, options, context);
        if (!made.ok() && made.error().code == ErrorCode::out_of_memory && max_memory != 0) {
            Error error = made.error();
            error.remedy += ", or raise --max-memory";
            return error;
        }
        LUMEL_TRY(Atlas atlas, std::move(made));
        report.predicted_memory_bytes =
            bake_memory(scene, geometry, atlas, {cell_samples, border_edges, collapses}, context.threads());
        if (max_memory == 0 || report.predicted_memory_bytes <= max_memory) return atlas;
        if (one_page || is_kept || options.max_page <= kSmallestPage) break;
        std::uint64_t kept = scene_memory(scene, geometry, atlas);
        if (cell_samples > 0) {
            const CellMemory cells = cell_memory(geometry, atlas, cell_samples);
            if (kept + cells.cells + cells.links > max_memory) break;  // which no smaller page would help
            kept += cells.cells;
        }
        if (seams) kept += seam_memory(*border_edges, atlas).samples;
        const std::uint64_t left = max_memory > kept ? max_memory - kept : 0;
        options.max_page = edge_that_fits(options.max_page / 2, options.masks.mips, seams, left, context.threads());
    }
    std::string remedy = is_kept
                             ? "raise --max-memory, or leave out --atlas: pages of a layout that is kept stay as large"
                         : one_page ? "raise --max-memory, or lower --resolution: a single page cannot be split"
                         : options.atlas_bytes > 0 ? "raise --max-memory, or lower --atlas-bytes or --threads"
                                                   : "raise --max-memory, or lower --texels-per-metre or --threads";
    if (cell_samples > 0) remedy += "; --integrator paths needs less";
    return Error{ErrorCode::out_of_memory,
                 "this bake is predicted to need about " + megabytes(report.predicted_memory_bytes) +
                     " but --max-memory allows " + std::to_string(max_memory >> 20) + " MB",
                 scene.source, remedy};
}

// Running totals over all pages for the report's error estimate.
struct Totals {
    double relative_error = 0.0;  // of a texel's mean that is to be reached; 0: none
    double variance = 0.0, irradiance[3] = {0, 0, 0};
    std::uint64_t texels = 0, measured = 0;  // measured: of more than one path, so that they have a variance
    std::uint32_t most_samples = 0;          // of a texel
    // At relative_error; of the others, which no light has reached, and which of the rest took all samples.
    std::uint64_t within = 0, unlit = 0, exhausted = 0;

    void add(const Lightmap& map, const std::array<bool, kLayerCount>& included) {
        for (std::size_t i = 0; i < map.texels.size(); ++i) {
            if (map.coverage[i] != Coverage::baked) continue;
            ++texels;
            measured += map.texels.count[i] > 1 ? 1 : 0;
            Vec3 mean{}, error{};
            for (std::size_t c = 0; c < 3; ++c) {
                variance += static_cast<double>(map.texels.variance[i][c]);
                error[c] = std::sqrt(map.texels.variance[i][c]);
                for (std::size_t l = 0; l < kLayerCount; ++l)
                    if (included[l]) mean[c] += map.texels.layers[i][l].irradiance[c];
                irradiance[c] += static_cast<double>(mean[c]);
            }
            // Channels err together, for it is the same light that they have met or missed.
            const bool is_unlit = !(max_component(mean) > 0.0f);
            const bool is_within =
                map.texels.count[i] > 1 && !is_unlit &&
                static_cast<double>(luminance(error)) <= relative_error * static_cast<double>(luminance(mean));
            within += is_within ? 1 : 0;
            unlit += is_unlit ? 1 : 0;
            exhausted += !is_within && !is_unlit && map.texels.count[i] >= most_samples ? 1 : 0;
        }
    }
    [[nodiscard]] bool is_black() const { return irradiance[0] + irradiance[1] + irradiance[2] == 0.0; }

    void store(BakeReport& report) const {
        report.share_within_error = report.share_unlit = report.share_out_of_samples =
            std::numeric_limits<double>::quiet_NaN();
        if (texels == 0) return;
        const double n = static_cast<double>(texels);
        if (relative_error > 0.0) {
            report.share_within_error = static_cast<double>(within) / n;
            report.share_unlit = static_cast<double>(unlit) / n;
            report.share_out_of_samples = static_cast<double>(exhausted) / n;
        }
        double mean = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            report.mean_irradiance[c] = irradiance[c] / n;
            mean += report.mean_irradiance[c] / 3.0;
        }
        if (2 * measured < texels)
            report.estimated_nrmse = std::numeric_limits<double>::quiet_NaN();
        else if (mean > 0.0)
            report.estimated_nrmse = std::sqrt(variance / (3.0 * n)) / mean;
    }
};

// What the pages are baked from, one at a time.
struct PageBaker {
    const Scene& scene;
    const ChartSet& charts;
    const Atlas& atlas;
    const Transport& transport;
    const BakeOptions& options;
    const PathOptions& path;
    BakeReport& report;
    CellBias& bias;
    SeamBlender* seams;  // none: seams stay as they are
    Context& context;

    // The texel buffer lives no longer than this.
    [[nodiscard]] Result<Lightmap> bake(std::uint32_t page, const std::vector<std::uint32_t>& triangles) const {
        TexelBuffer texels;
        TexelSurface surface;
        RadianceSums sums;
        {
            const StageTimer timer(report, "texels");
            LUMEL_TRY(texels, rasterize_page(scene, transport.geometry, charts, atlas, page, triangles, context));
            LUMEL_TRY(surface, read_texel_surface(texels, scene, transport.geometry, charts, atlas, context));
        }
        {
            const StageTimer timer(report, "trace");
            ProgressParts progress(context, "trace", transport.cells ? 1.0 + kCellBiasWork : 1.0);
            progress.begin(1.0);
            const std::size_t room = texels_with_rings(texels, options.dilate);
            LUMEL_TRY(sums, gather_page(texels, charts, atlas, transport, path, 0, texels.size(), context, room));
            if (transport.cells) {
                progress.begin(kCellBiasWork);
                LUMEL_TRY_STATUS(measure_cell_bias(texels, charts, atlas, transport, path, bias, context));
            }
            report.trace_wall_seconds += timer.seconds();
        }
        for (const std::uint32_t count : sums.count) report.samples += count;
        LUMEL_TRY_STATUS(pool_variance(texels, sums, context));
        const bool smooth = options.denoise.value_or(preset_values(options.preset).denoise);
        if (smooth) {
            const StageTimer timer(report, "denoise");
            DenoiseOptions smoothing;
            smoothing.included = path.included;
            LUMEL_TRY_STATUS(denoise(texels, smoothing, sums, context));
        }
        const StageTimer timer(report, "post");
        if (transport.cells) LUMEL_TRY_STATUS(add_cell_noise(texels, charts, atlas, transport, path, sums, context));
        const std::vector<std::uint32_t> readers = chart_ids(scene, charts, atlas, page);
        LUMEL_TRY(Lightmap map,
                  finish_page(texels, std::move(sums), std::move(surface), readers, options.dilate, context));
        if (atlas.masks.mips > 0) {
            LUMEL_TRY(map.leaks, find_mip_leaks(texels, transport, atlas.masks.mips, context));
        }
        if (smooth) LUMEL_TRY_STATUS(fit_to_lookup(texels, {}, map, context));
        if (seams) {
            const StageTimer seam_timer(report, "seams");
            LUMEL_TRY_STATUS(seams->blend(map, context));
        }
        report.pages.push_back(page_report(map, texels.size()));
        return map;
    }
};

// Progress of each stage is that over all pages. `kept`: where pages go instead of being written.
Status bake_pages(const PageBaker& baker, const PageOutput& output, Totals& totals, InsideOutCheck& inside_out,
                  std::vector<Lightmap>* kept) {
    const auto work = [](const AtlasPage& page) {
        return static_cast<double>(std::uint64_t{page.width} * page.height);
    };
    double all = 0.0;
    for (const AtlasPage& page : baker.atlas.pages) all += work(page);
    ProgressParts progress(baker.context, all);
    const auto by_page = triangles_by_page(baker.scene, baker.transport.geometry, baker.charts, baker.atlas);
    for (std::uint32_t page = 0; page < baker.atlas.pages.size(); ++page) {
        progress.begin(work(baker.atlas.pages[page]));
        LUMEL_TRY(Lightmap map, baker.bake(page, by_page[page]));
        totals.add(map, baker.path.included);
        inside_out.add(map);
        if (kept)
            kept->push_back(std::move(map));
        else
            LUMEL_TRY_STATUS(output.write(baker.atlas, map));
    }
    return success();
}

// Where the scene's seams are, and what blends them.
Result<SeamBlender> make_seam_blender(const ChartSet& charts, const Atlas& atlas, const Transport& transport,
                                      BakeReport& report, Context& context) {
    const StageTimer timer(report, "seams");
    const SeamRule rule;
    SeamOptions options;
    options.filter = atlas.masks.filter;
    const std::vector<BorderEdge> edges = find_border_edges(transport.scene, transport.geometry, charts, atlas);
    LUMEL_TRY(const std::vector<Seam> seams, find_seams(edges, rule, context));
    LUMEL_TRY(SeamSamples samples,
              make_seam_samples(edges, seams, rule, options.samples_per_texel, transport.tracer, context));
    report.seam_metres = samples.metres;
    report.seam_samples = samples.samples.size();
    report.hidden_seam_samples = samples.hidden;
    return SeamBlender(std::move(samples.samples), atlas, options);
}

// For options.time_seconds by the clock of the bake: page 0 is rasterised for the trial, and again when its turn has
// come.
Result<std::uint32_t> samples_in_time(const Scene& scene, const ChartSet& charts, const Atlas& atlas,
                                      const Transport& transport, const BakeOptions& options, const PathOptions& path,
                                      bool has_cells, const Stopwatch& clock, Context& context) {
    const Stopwatch raster;
    const auto by_page = triangles_by_page(scene, transport.geometry, charts, atlas);
    LUMEL_TRY(const TexelBuffer texels,
              rasterize_page(scene, transport.geometry, charts, atlas, 0, by_page[0], context));
    const TimePlan plan{charts, atlas, texels, clock.seconds(), raster.seconds(), has_cells};
    return samples_within_time(plan, options, transport, path, context);
}

}  // namespace

Result<BakeReport> bake(const Scene& scene, const BakeOptions& options, const BakeSink& sink, Context& context) {
    std::optional<FlushDenormals> flush(std::in_place);  // in what this thread computes by itself, too
    BakeReport report;
    report.threads = context.threads();
    const Stopwatch clock;

    if (options.stop != StopRule::fixed && !(options.error > 0.0))
        return Error{ErrorCode::usage, "the error to stop at is not above zero", {}, "give --error, for example 0.05"};
    if (options.collapse > 0.0 && (options.atlas || options.resolution_width != 0))
        return Error{ErrorCode::usage,
                     std::string("--collapse makes a layout of its own and does not go with ") +
                         (options.atlas ? "--atlas" : "--resolution"),
                     {},
                     "leave one out"};
    LUMEL_TRY_STATUS(validate(scene));
    LUMEL_TRY(const WorldGeometry geometry, flatten(scene, context));
    report.input_hash = hash_scene(scene).hex();
    const SurfaceReader surfaces(scene, geometry);
    const LightSet lights = [&] {
        const StageTimer timer(report, "lights");
        return LightSet(scene, geometry, surfaces);
    }();
    if (lights.empty())
        return Error{ErrorCode::invalid_input, "the scene has no light, no emissive surface and no sky", scene.source,
                     "give it a sky, for example --sky 1,1,1, or a sun with --sun-direction"};

    PathOptions path = path_options(options, geometry);
    std::uint32_t cell_samples = samples_for_cells(options, path);
    ChartSet charts;
    Atlas atlas;
    {
        const StageTimer timer(report, "charts");
        LUMEL_TRY(charts, make_charts(scene, geometry, chart_options(options), context));
    }
    std::unique_ptr<Tracer> tracer;
    {
        const StageTimer timer(report, "acceleration");
        LUMEL_TRY(tracer, make_embree_tracer(geometry, surfaces, context));
    }
    Transport transport{scene, geometry, surfaces, lights, *tracer};
    // Both sides of a surface share its texels, so that neither alone can be called dark. A layout that is kept has a
    // density of its own, as if it had been asked for.
    if (!charts.scene_wide && !(options.texels_per_metre > 0.0) && !options.two_sided && !options.atlas) {
        const StageTimer timer(report, "sealed");
        LUMEL_TRY(charts.sealed, find_sealed_charts(charts, texel_budget(options), transport, context));
        report.trace_wall_seconds += timer.seconds();
    }
    {
        const StageTimer timer(report, "atlas");
        const Diagnostics before = context.diagnostics;
        const auto lay_out = [&] {
            return make_atlas_within_memory(scene, geometry, charts, chart_options(options), cell_samples,
                                            options.seams, options.collapse > 0.0, options.max_memory_bytes, report,
                                            context);
        };
        Result<Atlas> laid_out = lay_out();
        if (!laid_out.ok() && laid_out.error().code == ErrorCode::out_of_memory && cell_samples > 0 &&
            options.integrator == Integrator::automatic) {
            cell_samples = 0;
            context.diagnostics = before;
            laid_out = lay_out();
            if (laid_out.ok())
                context.diagnostics.add("no-cells", "--max-memory has no room for surface cells: this bake is slower",
                                        scene.source);
        }
        LUMEL_TRY(atlas, std::move(laid_out));
    }
    if (atlas.pages.empty())
        return Error{ErrorCode::invalid_input, "no surface of the scene gets lightmap texels", scene.source,
                     "every node is of another class than lightmap (lumel info lists them), has no area, or falls into "
                     "charts far "
                     "smaller than a texel: ask for more --texels-per-metre"};
    const bool collapses = options.collapse > 0.0;
    if (collapses && charts.scene_wide)
        return Error{ErrorCode::usage, "--collapse moves charts, and TEXCOORD_1 is kept as one atlas of the scene",
                     scene.source, "take --uv1 mesh or ignore, or leave --collapse out"};
    if (sink.layout && !collapses) LUMEL_TRY_STATUS(sink.layout(geometry, charts, atlas));

    if (options.time_seconds > 0.0) {
        const StageTimer timer(report, "trial");
        LUMEL_TRY(path.samples,
                  samples_in_time(scene, charts, atlas, transport, options, path, cell_samples > 0, clock, context));
        if (cell_samples > 0) cell_samples = samples_for_cells(options, path);
        report.trace_wall_seconds += timer.seconds();
    }
    report.samples_per_texel = path.samples;
    std::optional<SurfaceCells> cells;
    if (cell_samples > 0) {
        const StageTimer timer(report, "cells");
        PathOptions to_cells = path;
        to_cells.samples = cell_samples;
        LUMEL_TRY(cells, make_lit_cells(charts, atlas, transport, to_cells, context));
        transport.cells = &*cells;
        path.guided = path.lights_learned = options.guide;
        report.cells = cells->size();
        report.trace_wall_seconds += timer.seconds();
    }
    Totals totals;
    if (options.stop != StopRule::fixed) totals.relative_error = path.relative_error_of_mean;
    totals.most_samples = path.samples;
    CellBias bias;
    std::optional<SeamBlender> seams;
    if (options.seams) {
        LUMEL_TRY(seams, make_seam_blender(charts, atlas, transport, report, context));
    }
    const PageBaker baker{scene,  charts, atlas, transport, options, path, report, bias, seams ? &*seams : nullptr,
                          context};
    std::vector<Lightmap> kept;
    const PageOutput output{scene, geometry, charts, options, sink, report, context};
    InsideOutCheck inside_out(atlas);
    LUMEL_TRY_STATUS(bake_pages(baker, output, totals, inside_out, collapses ? &kept : nullptr));
    seams.reset();
    inside_out.warn({scene, geometry, surfaces, lights, *tracer}, context.diagnostics);
    if (collapses) LUMEL_TRY_STATUS(output.write_collapsed(kept, atlas));
    kept.clear();
    kept.shrink_to_fit();
    report.cell_bias = bias.relative();
    report.cell_bias_error = bias.standard_error();
    for (const PageReport& page : report.pages) {
        report.texels += page.texels;
        report.invalid_texels += page.invalid;
    }
    totals.store(report);
    if (report.texels > 0 && totals.is_black())
        context.diagnostics.add(
            "no-light",
            "No light of the included layers reaches any texel: the bake is black; look at where the "
            "lights are and point, at what stands in their way, and at --include",
            scene.source);
    const TraceStatistics statistics = tracer->statistics();
    report.rays = statistics.rays;
    report.tracer_seconds = statistics.seconds;
    report.rays_per_second =
        report.trace_wall_seconds > 0.0 ? static_cast<double>(report.rays) / report.trace_wall_seconds : 0.0;
    report.tracer = std::string(tracer->description());
    report.triangles = geometry.triangle_count();
    report.instances = scene.instances.size();
    report.charts = atlas.placements.size();
    report.kept_charts = atlas.kept;
    report.texels_per_metre = atlas.texels_per_metre;
    report.least_texels_per_metre = atlas.least_texels_per_metre;
    report.peak_memory_bytes = peak_memory();
    if (sink.finished) {
        transport.cells = nullptr;
        cells.reset();
        flush.reset();
        LUMEL_TRY_STATUS(sink.finished(transport, report));
    }
    return report;
}

}  // namespace lumel
