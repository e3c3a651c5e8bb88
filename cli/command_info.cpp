// lumel info: what Lumel sees in a scene.
#include <cstdio>

#include "base/try.h"
#include "command.h"
#include "io/gltf_document.h"
#include "io/info.h"

namespace lumel::cli {

Run add_info(CLI::App& app) {
    struct Options {
        std::string scene;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    app.add_option("SCENE", options->scene, "glTF scene: .glb or .gltf")->required();
    app.add_flag("--json", options->json, "As JSON");
    return [options] {
        Context context(1);
        const Result<LoadedScene> loaded = load_scene(options->scene, context);
        if (!loaded.ok()) return fail(loaded.error(), "info");
        const std::string text = options->json ? describe_json(loaded->scene, context.diagnostics)
                                               : describe(loaded->scene, context.diagnostics);
        std::fputs(text.c_str(), stdout);
        return static_cast<int>(kDone);
    };
}

}  // namespace lumel::cli
