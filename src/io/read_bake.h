// The output folder of a bake as a viewer loads it: scene.glb alone says which surface looks up what.
#pragma once

#include <filesystem>

#include "check/checked_bake.h"
#include "lumel/result.h"

namespace lumel {

// All pages at once: some 40 bytes a pixel. Errors: io; invalid_input where the folder holds no bake, or files that do
// not belong together.
Result<CheckedBake> read_bake(const std::filesystem::path& folder);

}  // namespace lumel
