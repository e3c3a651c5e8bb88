// The output folder of a bake as a viewer loads it: scene.glb alone says which surface looks up what.
#pragma once

#include <filesystem>

#include "check/checked_bake.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

struct BakeOnDisk {
    Scene scene;  // of scene.glb; what is lightmapped takes part in it
    CheckedBake bake;
};

// All pages at once: some 40 bytes a pixel. Errors: io, also where another bake replaced this one meanwhile;
// invalid_input where the folder holds no bake, or files that do not belong together.
// Stage "load". Also cancelled.
Result<BakeOnDisk> read_bake(const std::filesystem::path& folder, Context& context);

}  // namespace lumel
