// lumel: command-line baker for glTF scenes. Exit codes: 0 done, 1 failed, 2 usage.
#include <vector>

#include "command.h"

int main(int argc, char** argv) {
    using namespace lumel::cli;
    CLI::App app{"Lumel bakes precomputed global illumination for glTF scenes."};
    app.require_subcommand(1);
    app.set_version_flag("--version", LUMEL_VERSION);
    app.option_defaults()->always_capture_default();

    struct Command {
        CLI::App* app;
        Run run;
    };
    std::vector<Command> commands;
    const auto add = [&](const char* name, const char* about, Run (*declare)(CLI::App&)) {
        CLI::App* sub = app.add_subcommand(name, about);
        commands.push_back({sub, declare(*sub)});
    };
    add("info", "What Lumel sees in a scene", add_info);
    add("bake", "Bake a scene's lighting", add_bake);
    add("render", "Path-traced picture of a scene, or the same view lit by a bake", add_render);
    add("compare", "How far two images are apart", add_compare);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kUsage;  // --help and --version come this way too
    }
    for (const Command& command : commands)
        if (command.app->parsed()) return command.run();
    return kUsage;
}
