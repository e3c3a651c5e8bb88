// Reads the layout that manifest.json or atlas.json records, for a later one that keeps it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "chart/atlas_record.h"
#include "lumel/result.h"

namespace lumel {

// Errors: io; invalid_input where it is no manifest, an older one that does not name its charts, or one whose numbers
// cannot be a layout. Whether boxes lie on top of each other is not looked at (make_atlas does).
Result<std::shared_ptr<const AtlasRecord>> read_atlas_record(const std::filesystem::path& file);
Result<AtlasRecord> parse_atlas_record(std::string_view json, const std::string& where);

}  // namespace lumel
