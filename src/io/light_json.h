// How manifest and report spell the options of light; light_record.h reads it back.
#pragma once

#include <filesystem>
#include <string>

#include "io/json_write.h"
#include "lumel/options.h"

namespace lumel {

// `sky_hash`: of the sky map's file, where the options name one. `folder`: which paths are relative to.
Json sky_json(const SkyOptions& sky, const std::string& sky_hash, const std::filesystem::path& folder);
// null: the options have no sun.
Json sun_json(const SunOptions& sun);
// Of the layers that are included.
Json layer_names(const Include& include);

}  // namespace lumel
