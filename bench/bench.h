// The subcommands of lumel_bench. Each adds itself to the command line and prints CSV to standard output when chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <ctime>

namespace lumel::bench {

void add_trace(CLI::App& app);      // rays per second
void add_texels(CLI::App& app);     // rasterising pages, sample points
void add_replay(CLI::App& app);     // the bake against its own rays
void add_transport(CLI::App& app);  // error against cost, method by method
void add_charts(CLI::App& app);     // charts of scenes: seams, stretch, time
void add_pack(CLI::App& app);       // chart masks: texels used, time
void add_encodings(CLI::App& app);  // error of encodings over normals
void add_leaks(CLI::App& app);      // light on the wrong side of walls
void add_bc(CLI::App& app);         // block compression
void add_seams(CLI::App& app);      // contrast along seams, before and after

// CPU time of the process, all threads together: the machine's other work does not count.
class CpuStopwatch {
public:
    [[nodiscard]] double seconds() const { return now() - start_; }

private:
    static double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
    double start_ = now();
};

}  // namespace lumel::bench
