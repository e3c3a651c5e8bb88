// lumel inspect: the g-buffer and the light of a bake, texel by texel, on its pages and through cameras.
#include <cstdio>
#include <sstream>

#include "base/try.h"
#include "camera.h"
#include "command.h"
#include "interrupt.h"
#include "job/inspect.h"
#include "render/picture.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string folder, output, scene, layers = "state", filter = "bilinear", dilation = "on", backs = "magenta";
    std::string resolution = "960x540", progress;
    std::vector<std::string> cameras;
    const CLI::Option* page_option = nullptr;
    std::uint32_t page = 0, threads = 0;
    bool values = false;
};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) out.push_back(word);
    return out;
}

Status print_list(const std::string& folder) {
    LUMEL_TRY(const std::vector<LayerText> layers, list_layers(folder));
    for (const LayerText& layer : layers) std::printf("%-24s %s\n", layer.name.c_str(), layer.text.c_str());
    return success();
}

// Those that were asked for, or the views that the bake drew.
Result<std::vector<Camera>> cameras_for(const Options& options, const Transport& transport, Context& context) {
    if (options.cameras.empty()) return choose_views(transport, count_views(options.folder), context);
    std::vector<Camera> out;
    for (const std::string& text : options.cameras) {
        LUMEL_TRY(Camera camera, find_camera(text, transport, context));
        out.push_back(std::move(camera));
    }
    return out;
}

bool wants_views(const Options& options) {
    if (options.cameras.empty()) return count_views(options.folder) > 0;
    return options.cameras.size() > 1 || options.cameras.front() != "none";
}

Status run(const Options& options) {
    if (options.layers == "list") return print_list(options.folder);
    LUMEL_TRY(const Size size, parse_size(options.resolution, "--resolution"));
    InspectOptions job;
    job.folder = options.folder;
    job.output = options.output.empty() ? options.folder + "/inspect" : options.output;
    job.scene = options.scene;
    job.layers = split(options.layers);
    if (options.page_option->count() > 0) job.page = options.page;
    job.width = size.width;
    job.height = size.height;
    job.filter = options.filter == "point"     ? ViewFilter::point
                 : options.filter == "bicubic" ? ViewFilter::bicubic
                                               : ViewFilter::bilinear;
    job.dilation = options.dilation == "on";
    job.through_backs = options.backs == "through";
    job.values = options.values;
    if (wants_views(options))
        job.cameras = [&](const Transport& transport, Context& context) {
            return cameras_for(options, transport, context);
        };
    RunContext run_context(options.threads, options.progress);
    const InspectHooks hooks{
        [&](std::function<void()> cleaner) { run_context.interrupt().set_cleaner(std::move(cleaner)); },
        [&] { return run_context.interrupt().begin_commit(); }};
    LUMEL_TRY(const std::vector<std::string> files, inspect(job, hooks, run_context.get()));
    run_context.finish();
    for (const std::string& file : files) std::printf("%s\n", (job.output / file).string().c_str());
    return success();
}

}  // namespace

Run add_inspect(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("DIR", options->folder, "Output folder of lumel bake")->required();
    app.add_option("--layer", options->layers,
                   "Layers to show, such as state,normal,light; 'list' prints all there are")
        ->check(not_empty());
    app.add_option("-o,--output", options->output, "Folder for the pictures")
        ->default_str("DIR/inspect")
        ->check(not_empty());
    app.add_option("--scene", options->scene, "The scene that was baked")
        ->default_str("where the manifest says")
        ->check(not_empty());
    app.add_option("--camera", options->cameras,
                   "Name of a camera, 'view K', or eye;target;vfov_degrees; may be repeated; 'none': no views")
        ->default_str("the views that the bake drew")
        ->allow_extra_args(false)
        ->check(not_empty());
    app.add_option("--resolution", options->resolution, "Of the views: width x height in pixels")->check(not_empty());
    options->page_option = app.add_option("--page", options->page, "Which page to draw")->default_str("all");
    app.add_option("--filter", options->filter, "How views look texels up")
        ->check(CLI::IsMember({"point", "bilinear", "bicubic"}));
    app.add_option("--dilation", options->dilation, "off: without the texels around the charts")
        ->check(CLI::IsMember({"on", "off"}));
    app.add_option("--backs", options->backs,
                   "What views show behind single-sided faces: magenta, or what lies beyond as viewers do")
        ->check(CLI::IsMember({"magenta", "through"}));
    app.add_flag("--values", options->values, "Write the numbers, too, as .exr");
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    declare_progress(app, options->progress);
    return [options] {
        const Status status = run(*options);
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "inspect");
    };
}

}  // namespace lumel::cli
