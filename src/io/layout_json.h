// What manifest.json and atlas.json say alike: where every chart of every instance lies. And how both are written.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

#include "chart/chart_set.h"
#include "io/json_read.h"
#include "lumel/scene.h"

namespace lumel {

// What lookups may touch without meeting two charts.
Json lookups_json(const MaskRule& masks);

Json instances_json(const Scene& scene, const ChartSet& charts, const Atlas& atlas);
// One array per member: hundreds of thousands of charts stay readable by machines.
Json charts_json(const Scene& scene, const ChartSet& charts, const Atlas& atlas);

// Indented. A file name need not be UTF-8; JSON must: what is not is replaced. Errors: io.
Status write_json(const std::filesystem::path& path, const Json& json);
// The same, but each of these members of the object on one line: indented they would take a line per number.
Status write_with_long_arrays(const std::filesystem::path& path, const Json& json,
                              std::initializer_list<std::string_view> long_members);

}  // namespace lumel
