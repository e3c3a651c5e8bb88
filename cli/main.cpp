// lumel: command-line baker for glTF scenes. Exit codes: 0 done, 1 failed, 2 usage.
#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

#include "command.h"
#include "suggest.h"

namespace lumel::cli {
namespace {

// "; did you mean --samples?" where the first option that the command does not have resembles one that it has.
std::string meant_option(const CLI::App& command) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : command.remaining()) {
        if (!word.starts_with("--")) continue;
        const std::string meant = closest_word(word.substr(0, word.find('=')), known);
        return meant.empty() ? meant : "; did you mean " + meant + "?";
    }
    return {};
}

// What the parser did not understand, as one line like any other error.
int usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    if (!parsed.empty()) {
        std::string message = error.what();
        if (message.starts_with("The ")) message.front() = 't';  // what is not the name of an argument
        return fail({ErrorCode::usage, message + meant_option(*parsed.front()), {}, {}}, parsed.front()->get_name());
    }
    // The parser would only say that there is no command.
    char** const word = std::find_if(argv + 1, argv + argc, [](std::string_view a) { return !a.starts_with('-'); });
    std::string commands;
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) {
        names.push_back(command->get_name());
        commands += (commands.empty() ? "" : ", ") + names.back();
    }
    const std::string meant = word != argv + argc ? closest_word(*word, names) : std::string{};
    const std::string message = word != argv + argc ? "there is no command '" + std::string(*word) + "'" +
                                                          (meant.empty() ? meant : "; did you mean " + meant + "?")
                                : argc > 1 ? "there is no option '" + std::string(argv[1]) + "' without a command"
                                           : "a command is missing";
    return fail({ErrorCode::usage, message, {}, "commands: " + commands + "; see lumel --help"}, {});
}

// What was printed is not all there.
int lost_output() {
    std::fprintf(stderr, "lumel: error: standard output: cannot be written (is its disk full?)\n");
    return kFailed;
}

}  // namespace
}  // namespace lumel::cli

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
    add("atlas", "Unwrap and pack a scene, without light", add_atlas);
    add("render", "Path-traced picture of a scene, or the same view lit by a bake", add_render);
    add("compare", "How far two images are apart", add_compare);
    add("pack", "Pack raw chart masks into an atlas", add_pack);
    add("encode", "A bake's light in another encoding, or the error of all of them", add_encode);
    add("check", "Is a bake fit to ship: seams, bad texels, layout; exit code 1 above thresholds", add_check);
    add("inspect", "Pictures of what a bake knows of each texel, on its pages and through cameras", add_inspect);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) return usage_error(app, error, argc, argv);
        return app.exit(error);  // --help and --version come this way too
    }
    for (const Command& command : commands)
        if (command.app->parsed()) {
            const int code = command.run();
            return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? code : lost_output();
        }
    return kUsage;
}
