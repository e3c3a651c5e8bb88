// The bake as a library call: pages go to a sink. To a folder of files: lumel/bake_folder.h.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lumel/context.h"
#include "lumel/options.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// Opaque to users of the package: to be handed on. read_pixels() (lumel/page.h) has the pixels of a Lightmap.
struct Lightmap;  // post/lightmap.h
struct ChartSet;  // chart/chart_set.h
struct Atlas;
struct WorldGeometry;
struct Transport;  // path/path_integrator.h

struct StageTime {
    std::string stage;
    double wall_seconds = 0.0, cpu_seconds = 0.0;
};

struct PageReport {
    std::uint32_t page = 0, width = 0, height = 0;
    std::uint64_t texels = 0, invalid = 0, filled = 0, dilated = 0;
    double coverage = 0.0;  // baked texels over all texels of the page
};

// What report.json says.
struct BakeReport {
    std::string input_hash;
    std::vector<StageTime> stages;
    std::vector<PageReport> pages;
    std::uint64_t triangles = 0, instances = 0, charts = 0, texels = 0, invalid_texels = 0;
    std::uint64_t cells = 0;          // surface cells that paths end at; 0: brute force
    std::uint64_t samples = 0;        // traced, over all texels
    std::uint64_t rays = 0;           // all kinds
    double trace_wall_seconds = 0.0;  // wall time of the stage that traces
    double tracer_seconds = 0.0;      // inside the tracer's calls, summed over threads
    double rays_per_second = 0.0;     // rays over trace_wall_seconds
    // From the stored variance, before denoising: sqrt(mean variance) / mean irradiance. NaN: of single paths, unknown.
    // Of the texels' own paths: the noise of the surface cells, which is common to many texels, is not in it.
    double estimated_nrmse = 0.0;
    // What the surface cells add to all light of the included layers, as a share of it, and the standard error of that:
    // some texels are gathered a second time without them. NaN: no cells, or no light.
    double cell_bias = 0.0, cell_bias_error = 0.0;
    // Samples per texel, or the most where texels stop by themselves; --samples with this number gives the same bits as
    // --time did; with max_memory_bytes only where that changed neither layout nor cells.
    std::uint32_t samples_per_texel = 0;
    // Share of texels that are not black and whose interval at options.confidence, as traced, is within options.error
    // of their irradiance (luminance). NaN where nothing was to be reached.
    double share_within_error = 0.0;
    // Of the others: those that no light has reached, and those of the rest that took all samples. What is left stopped
    // by what the texels around it have measured (StopRule::error). NaN where nothing was to be reached.
    double share_unlit = 0.0, share_out_of_samples = 0.0;
    double mean_irradiance[3] = {0, 0, 0};  // I = E/pi over baked texels
    // Where charts meet on one surface; 0 with options.seams off. Hidden: something stands there.
    double seam_metres = 0.0;
    std::uint64_t seam_samples = 0, hidden_seam_samples = 0;
    std::uint64_t collapsed_charts = 0;   // by options.collapse
    double texels_per_metre = 0.0;        // reached, mean over the area; below what was asked where charts were clamped
    double least_texels_per_metre = 0.0;  // of any chart that was not asked for less
    std::uint64_t peak_memory_bytes = 0;  // of the process so far, when this was last looked at
    std::uint64_t predicted_memory_bytes = 0;  // before the first page: for all that `lumel bake` does
    std::string tracer;                        // back end and instruction set
    unsigned threads = 0;
    std::uint64_t kept_charts = 0;  // in the places that options.atlas gives them
};

// Receives pages in order as they are done, so that a level larger than memory can be streamed to disk. A member left
// empty is not called.
struct BakeSink {
    // After charts and atlas, before any page.
    std::function<Status(const WorldGeometry&, const ChartSet&, const Atlas&)> layout;
    // Each page is followed by its mips from 1 on, where BakeOptions::mips asks for some (Lightmap::mip).
    std::function<Status(const Lightmap&)> page;
    // After the last page, while what its light was traced in still stands: for pictures of the result. The report is
    // that which bake() returns; stages may be added.
    std::function<Status(const Transport&, BakeReport&)> finished = {};
};

// Applies the options' sky and sun to the scene, once, before bake() or a render. A sky map named by the options has
// been loaded into scene.sky by the caller: files are `io`'s. Errors: usage, unsupported (no sun to extract),
// invalid_input (light brighter than Lumel takes).
Status apply_lighting(Scene& scene, const BakeOptions& options);

// Runs charts, atlas, texels, tracing and post-processing, page by page. The scene is as apply_lighting left it.
// Errors: invalid_input (no light: names --sky), out_of_memory (more than options.max_memory_bytes is needed: says how
// much is), cancelled, and whatever the sink returns.
Result<BakeReport> bake(const Scene& scene, const BakeOptions& options, const BakeSink& sink, Context& context);

}  // namespace lumel
