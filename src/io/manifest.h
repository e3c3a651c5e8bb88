// manifest.json, which says what the files of an output folder hold, and report.json, which says how the bake went.
// Schemas: docs/schema/; prose: docs/formats.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "chart/chart_set.h"
#include "encode/units.h"
#include "io/page_files.h"
#include "lumel/bake.h"
#include "lumel/scene.h"

namespace lumel {

// One file of a page as the manifest describes it.
struct ManifestFile {
    PageFile kind;
    std::string type;  // of its numbers: "half", "float", "half+float", "8-bit"
};

struct ManifestPage {
    std::uint32_t width = 0, height = 0;
    double coverage = 0.0;  // baked texels over all texels of the page
    std::vector<ManifestFile> files;
    float display_strength = 1.0f;   // of the page's emissive texture in scene.glb
    std::vector<ManifestPage> mips;  // from mip 1 on; these have neither mips nor display_strength of their own
};

struct ManifestInput {
    const Scene& scene;
    const ChartSet& charts;
    const Atlas& atlas;
    const BakeOptions& options;
    const BakeReport& report;
    std::span<const ManifestPage> pages;
    std::string geometry_hash;
    std::string sky_hash;          // of the file that the options' sky was read from
    std::filesystem::path folder;  // where the files are written
};

Status write_manifest(const ManifestInput& input);
Status write_report(const ManifestInput& input, const Diagnostics& diagnostics);

}  // namespace lumel
