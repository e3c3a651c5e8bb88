// What an output folder says of the bake that wrote it, for those who build its g-buffer once more: which scene, with
// which options, in which layout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "chart/atlas_record.h"
#include "chart/chart_set.h"
#include "lumel/options.h"
#include "lumel/result.h"

namespace lumel {

struct BakeRecord {
    std::filesystem::path folder;
    std::filesystem::path source;  // as found from here; empty where an older bake did not say
    std::string geometry_hash, input_hash;
    // Of all options those that charts and the starts of paths depend on, but for which nodes are of class volume by
    // their charts (layout); `atlas` is the layout itself.
    BakeOptions options;
    Atlas layout;  // placements as the manifest has them, bit for bit
};

// From manifest.json and report.json. Errors: io; invalid_input where they are not ours, or not of one bake.
Result<BakeRecord> read_bake_record(const std::filesystem::path& folder);
// What the manifest's text says of it; `where` names it in messages. Of the options that is `atlas` alone.
Result<BakeRecord> parse_bake_record(std::string_view manifest, const std::filesystem::path& folder,
                                     const std::string& where);

// Whether the charts are those that the layout was made of. Error: invalid_input.
Status check_charts(const BakeRecord& record, const Scene& scene, const ChartSet& charts);

}  // namespace lumel
