// lumel info: what Lumel sees in a scene.
#include <cstdio>

#include "bake/chart_options.h"
#include "base/try.h"
#include "chart/charts_of_uv1.h"
#include "command.h"
#include "io/gltf_document.h"
#include "io/info.h"

namespace lumel::cli {
namespace {

// TEXCOORD_1 is judged as by a bake with the usual options.
Result<std::string> told(const std::string& path, bool as_json) {
    Context context(1);
    LUMEL_TRY(const LoadedScene loaded, load_scene(path, context));
    const Scene& scene = loaded.scene;
    LUMEL_TRY(const WorldGeometry geometry, flatten(scene, context));
    LUMEL_TRY(const ChartSet uv1, charts_of_uv1(scene, geometry, chart_options({}), context));
    return as_json ? describe_json(scene, uv1, context.diagnostics) : describe(scene, uv1, context.diagnostics);
}

}  // namespace

Run add_info(CLI::App& app) {
    struct Options {
        std::string scene;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    app.add_option("SCENE", options->scene, "glTF scene: .glb or .gltf")->required();
    app.add_flag("--json", options->json, "As JSON");
    return [options] {
        const Result<std::string> text = told(options->scene, options->json);
        if (!text.ok()) return fail(text.error(), "info");
        std::fputs(text->c_str(), stdout);
        return static_cast<int>(kDone);
    };
}

}  // namespace lumel::cli
