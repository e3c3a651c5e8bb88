// Reads the layout that manifest.json or atlas.json records, for a later one that keeps it.
#pragma once

#include <string>
#include <string_view>

#include "chart/atlas_record.h"
#include "lumel/load.h"

namespace lumel {

// Errors as of read_atlas_record().
Result<AtlasRecord> parse_atlas_record(std::string_view json, const std::string& where);

}  // namespace lumel
