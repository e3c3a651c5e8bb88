// lumel_bench: what the parts of Lumel cost, on a scene of yours.
#include <cstdio>
#include <exception>

#include "bench.h"

int main(int argc, char** argv) {
    CLI::App app("Measures parts of Lumel; prints CSV.", "lumel_bench");
    app.require_subcommand(1);
    lumel::bench::add_trace(app);
    lumel::bench::add_texels(app);
    lumel::bench::add_replay(app);
    lumel::bench::add_transport(app);
    lumel::bench::add_charts(app);
    lumel::bench::add_pack(app);
    lumel::bench::add_encodings(app);
    lumel::bench::add_leaks(app);
    lumel::bench::add_bc(app);
    lumel::bench::add_seams(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumel_bench: %s\n", error.what());
        return 1;
    }
    return 0;
}
