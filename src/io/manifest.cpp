#include "io/manifest.h"

#include <cmath>
#include <span>

#include "encode/irradiance.h"
#include "io/json_write.h"
#include "io/layout_json.h"
#include "io/light_json.h"
#include "io/relative_path.h"

namespace lumel {
namespace {

constexpr unsigned kVersion = 1;

// What a kind of file holds, in words a program can compare.
struct FileMeaning {
    const char* name;
    const char* units;
    const char* encoding;
};

FileMeaning meaning_of(PageFile kind) {
    const char* const unit = unit_name(unit_of(kind));
    switch (kind) {
        case PageFile::lightmap: return {"lightmap", unit, "irradiance"};
        case PageFile::irradiance: return {"irradiance", unit, "irradiance"};
        case PageFile::l1: return {"l1", unit, "l1-normalised"};
        case PageFile::master: return {"master", unit, "l2-radiance-by-layer"};
        case PageFile::ao: return {"ao", "1", "share-free"};
        case PageFile::bent_normal: return {"bent_normal", "1", "mean-free-direction"};
        case PageFile::sky_visibility: return {"sky_visibility", "1", "share-free"};
        case PageFile::preview_atlas: return {"preview_atlas", "picture", "srgb"};
        case PageFile::preview_charts: return {"preview_charts", "picture", "srgb"};
        case PageFile::preview_samples: return {"preview_samples", "picture", "srgb"};
    }
    return {"", "", ""};
}

// JSON has no infinity.

Json files_json(const ManifestPage& page, std::uint32_t index, std::uint32_t mip) {
    Json files = Json::object();
    for (const ManifestFile& file : page.files) {
        const FileMeaning meaning = meaning_of(file.kind);
        files[meaning.name] = {{"file", page_file(file.kind, index, mip)},
                               {"units", meaning.units},
                               {"encoding", meaning.encoding},
                               {"type", file.type}};
    }
    return files;
}

Json page_json(const ManifestPage& page, std::uint32_t index) {
    Json mips = Json::array();
    for (std::uint32_t k = 0; k < page.mips.size(); ++k)
        mips.push_back({{"mip", k + 1},
                        {"width", page.mips[k].width},
                        {"height", page.mips[k].height},
                        {"files", files_json(page.mips[k], index, k + 1)}});
    return {{"index", index},
            {"file", page_file(PageFile::lightmap, index)},
            {"width", page.width},
            {"height", page.height},
            {"coverage", page.coverage},
            {"display_strength", json_number(page.display_strength)},
            {"mips", std::move(mips)},
            {"files", files_json(page, index, 0)}};
}

Json pages_json(std::span<const ManifestPage> pages) {
    Json out = Json::array();
    for (std::uint32_t p = 0; p < pages.size(); ++p) out.push_back(page_json(pages[p], p));
    return out;
}

Json frame_json() {
    return {{"space", "world"},
            {"handedness", "right"},
            {"up", "+Y"},
            {"length", "metre"},
            {"color", "linear Rec. 709"},
            {"uv_origin", "top left"},
            {"texel_centre", 0.5},
            {"sh_basis", "real orthonormal, Condon-Shortley signs"}};
}

bool is_denoised(const BakeOptions& options) { return options.denoise.value_or(preset_values(options.preset).denoise); }

Json manifest_json(const ManifestInput& in) {
    Json out;
    out["version"] = kVersion;
    out["generator"] = "Lumel";
    out["source"] = std::filesystem::path(in.scene.source).filename().string();
    out["source_path"] = relative_to(in.folder, in.scene.source);
    out["input_hash"] = in.report.input_hash;
    out["geometry_hash"] = in.geometry_hash;
    out["scene"] = kSceneFile;
    out["units"] = {{"lightmap", unit_name(unit_of(PageFile::lightmap))},
                    {"irradiance", unit_name(unit_of(PageFile::irradiance))},
                    {"l1", unit_name(unit_of(PageFile::l1))},
                    {"master", unit_name(unit_of(PageFile::master))},
                    {"scene_texture", "albedo x E/pi"}};
    out["encoding"] = {{"lightmap", "irradiance"}, {"directional", "l1-normalised"}};
    out["frame"] = frame_json();
    out["layers"] = {{"included", layer_names(in.options.include)}, {"master", layer_names(Include{})}};
    out["light"] = {{"sky", sky_json(in.options.sky, in.sky_hash, in.folder)},
                    {"sun", sun_json(in.options.sun)},
                    {"direct_scale", in.options.direct_scale},
                    {"indirect_scale", in.options.indirect_scale}};
    out["denoised"] = is_denoised(in.options);
    out["texels_per_metre"] = in.atlas.texels_per_metre;
    out["density"] = in.atlas.density;
    out["kept_charts"] = in.atlas.kept;
    out["lookups"] = lookups_json(in.atlas.masks);
    out["scene_wide_uvs"] = in.charts.scene_wide;
    out["figures"] = {{"estimated_nrmse", finite_or_null(in.report.estimated_nrmse)},
                      {"mean_irradiance", in.report.mean_irradiance}};
    out["pages"] = pages_json(in.pages);
    out["instances"] = instances_json(in.scene, in.charts, in.atlas);
    out["charts"] = charts_json(in.scene, in.charts, in.atlas);
    return out;
}

Json stages_json(const BakeReport& report) {
    Json out = Json::array();
    for (const StageTime& stage : report.stages)
        out.push_back({{"stage", stage.stage},
                       {"wall_seconds", finite_or_null(stage.wall_seconds)},
                       {"cpu_seconds", finite_or_null(stage.cpu_seconds)}});
    return out;
}

Json page_reports_json(const BakeReport& report) {
    Json out = Json::array();
    for (const PageReport& page : report.pages)
        out.push_back({{"page", page.page},
                       {"width", page.width},
                       {"height", page.height},
                       {"texels", page.texels},
                       {"invalid", page.invalid},
                       {"filled", page.filled},
                       {"dilated", page.dilated},
                       {"coverage", page.coverage}});
    return out;
}

Json warnings_json(const Diagnostics& diagnostics) {
    Json out = Json::array();
    for (const Diagnostic& item : diagnostics.all())
        out.push_back(
            {{"code", item.code}, {"message", item.message}, {"count", item.count}, {"examples", item.examples}});
    return out;
}

Json options_json(const ManifestInput& in) {
    const BakeOptions& options = in.options;
    static constexpr const char* kPresets[] = {"preview", "medium", "production"};
    static constexpr const char* kIntegrators[] = {"auto", "cells", "paths"};
    static constexpr const char* kStopRules[] = {"fixed", "error", "flux"};
    static constexpr const char* kUv1[] = {"automatic", "scene", "mesh", "ignore"};
    return {{"preset", kPresets[static_cast<std::size_t>(options.preset)]},
            {"samples", sample_budget(options)},
            {"bounces", options.bounces},
            {"seed", options.seed},
            {"resolution", {options.resolution_width, options.resolution_height}},
            {"max_page", options.max_page},
            {"texels_per_metre", options.texels_per_metre},
            {"atlas_bytes", options.atlas_bytes},
            {"bytes_per_texel", options.bytes_per_texel},
            {"pages", options.pages != 0 ? Json(options.pages) : Json(options.page_clusters ? "cluster" : "auto")},
            {"lookups", lookups_json(in.atlas.masks)},
            {"collapse", options.collapse},
            {"uv1", kUv1[static_cast<std::size_t>(options.uv1)]},
            {"denoise", is_denoised(options)},
            {"dilate", options.dilate},
            {"seams", options.seams},
            {"two_sided", options.two_sided},
            {"ao_distance", options.ao_distance},
            {"integrator", kIntegrators[static_cast<std::size_t>(options.integrator)]},
            {"guide", options.guide},
            {"stop", kStopRules[static_cast<std::size_t>(options.stop)]},
            {"error", options.error},
            {"confidence", options.confidence},
            {"time_seconds", options.time_seconds},
            {"sky", sky_json(options.sky, in.sky_hash, in.folder)},
            {"sun", sun_json(options.sun)},
            {"direct_scale", options.direct_scale},
            {"indirect_scale", options.indirect_scale},
            {"include", layer_names(options.include)},
            {"max_memory_bytes", options.max_memory_bytes}};
}

Json report_json(const ManifestInput& in, const Diagnostics& diagnostics) {
    const BakeReport& report = in.report;
    Json out;
    out["version"] = kVersion;
    out["input_hash"] = report.input_hash;
    out["options"] = options_json(in);
    out["stages"] = stages_json(report);
    out["pages"] = page_reports_json(report);
    out["triangles"] = report.triangles;
    out["instances"] = report.instances;
    out["charts"] = report.charts;
    out["texels"] = report.texels;
    out["invalid_texels"] = report.invalid_texels;
    out["texels_per_metre"] = report.texels_per_metre;
    out["least_texels_per_metre"] = report.least_texels_per_metre;
    out["collapsed_charts"] = report.collapsed_charts;
    out["cells"] = report.cells;
    out["samples"] = report.samples;
    out["rays"] = report.rays;
    out["rays_per_second"] = finite_or_null(report.rays_per_second);
    out["trace_wall_seconds"] = finite_or_null(report.trace_wall_seconds);
    out["tracer_seconds"] = finite_or_null(report.tracer_seconds);
    out["tracer"] = report.tracer;
    out["threads"] = report.threads;
    out["peak_memory_bytes"] = report.peak_memory_bytes;
    out["predicted_memory_bytes"] = report.predicted_memory_bytes;
    out["samples_per_texel"] = report.samples_per_texel;
    out["estimated_nrmse"] = finite_or_null(report.estimated_nrmse);
    out["cell_bias"] = finite_or_null(report.cell_bias);
    out["cell_bias_error"] = finite_or_null(report.cell_bias_error);
    out["seams"] = {{"metres", finite_or_null(report.seam_metres)},
                    {"samples", report.seam_samples},
                    {"hidden_samples", report.hidden_seam_samples}};
    out["share_within_error"] = finite_or_null(report.share_within_error);
    out["share_unlit"] = finite_or_null(report.share_unlit);
    out["share_out_of_samples"] = finite_or_null(report.share_out_of_samples);
    out["mean_irradiance"] = report.mean_irradiance;
    out["warnings"] = warnings_json(diagnostics);
    return out;
}

}  // namespace

Status write_manifest(const ManifestInput& input) {
    return write_with_long_arrays(input.folder / kManifestFile, manifest_json(input), {"charts", "instances"});
}

Status write_report(const ManifestInput& input, const Diagnostics& diagnostics) {
    return write_json(input.folder / kReportFile, report_json(input, diagnostics));
}

}  // namespace lumel
