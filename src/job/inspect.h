// The job of `lumel inspect`: from the folder of a bake to pictures of its layers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "inspect/view.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "path/path_integrator.h"

namespace lumel {

struct InspectOptions {
    std::filesystem::path folder;             // of the bake
    std::filesystem::path output;             // folder of the pictures
    std::filesystem::path scene;              // that was baked; empty: where the manifest says
    std::vector<std::string> layers;          // by name (list_layers())
    std::optional<std::uint32_t> page;        // which to draw; none: all
    std::uint32_t width = 960, height = 540;  // of the views
    ViewFilter filter = ViewFilter::bilinear;
    bool dilation = true;        // texels around the charts are there, as renderers see them
    bool through_backs = false;  // single-sided faces are looked through from behind, instead of being magenta
    bool values = false;         // numbers, too
    // Of the scene; none: no views.
    std::function<Result<std::vector<Camera>>(const Transport&, Context&)> cameras;
};

// What a layer is called and shows.
struct LayerText {
    std::string name, text;
};
// All layers, and what FILE:CHANNELS the folder has. Error: io, where it holds no bake.
Result<std::vector<LayerText>> list_layers(const std::filesystem::path& folder);

// How many views the bake drew.
std::size_t count_views(const std::filesystem::path& folder);

// Names of the files written, in order. All appear or none. `begun` gets what would remove the files that are not
// finished; `may_appear`, if set, is asked before they appear. Errors: usage for layers and pages that there are not,
// and those of BakedScene::load and of the bake's files; cancelled. Stages "texels", "starts", "pictures".
struct InspectHooks {
    std::function<void(std::function<void()> cleaner)> begun;
    std::function<bool()> may_appear;
};
Result<std::vector<std::string>> inspect(const InspectOptions& options, const InspectHooks& hooks, Context& context);

}  // namespace lumel
