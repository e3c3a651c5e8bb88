// The main job from end to end: a loaded scene becomes an output folder, as `lumel bake SCENE -o DIR` makes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "lumel/bake.h"
#include "lumel/load.h"
#include "lumel/page.h"

namespace lumel {

inline constexpr std::uint32_t kMostViews = 16;

struct FolderOptions {
    std::uint32_t views = 2;          // camera views rendered beside the path-traced truth, 0..kMostViews
    std::uint32_t view_samples = 32;  // paths per pixel of those, 1..65536
    // Members left empty are not called.
    std::function<Status(const PagePixels&)> page = {};  // each page once it is written, followed by its mips
    // Told where files are until the folder appears: what is left behind if the process ends before.
    std::function<void(const std::filesystem::path&)> begun = {};
    // Asked when all is written. False: no folder appears, and the error is `cancelled`.
    std::function<bool()> may_appear = {};
};

// Bakes and writes lit scene, pages, pictures, manifest and report (docs/formats.md) into `output`, which appears whole
// or not at all, in place of an earlier bake's. The scene is as load_lit_scene() left it. Errors: those of bake(), and
// io: what cannot be written, files of these names that no bake wrote, an output that would replace the input.
Result<BakeReport> bake_to_folder(const LoadedScene& loaded, const BakeOptions& options,
                                  const std::filesystem::path& output, const FolderOptions& folder, Context& context);

}  // namespace lumel
