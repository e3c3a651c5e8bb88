// The manifest of an output folder, from which all that reads a bake starts.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "lumel/result.h"

namespace lumel {

// manifest.json as bytes. Errors: io; one that says so where the folder is none, or holds no bake.
Result<std::vector<std::byte>> read_manifest(const std::filesystem::path& folder);

}  // namespace lumel
