// What the commands of `lumel` share: exit codes, the context of a run, option groups.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "io/light_record.h"
#include "lumel/lumel.h"

namespace lumel::cli {

enum Exit : int { kDone = 0, kFailed = 1, kUsage = 2 };
inline constexpr const char* kCancelledText = "lumel: error: cancelled, nothing was written";

// Prints "lumel: error: ..." and returns the exit code of the error. Faults of usage that come without advice get that
// of the command's --help.
int fail(const Error& error, const std::string& command);

// A subcommand: `add` declares its options on the app and returns what runs when it was chosen.
using Run = std::function<int()>;
Run add_info(CLI::App& app);
Run add_bake(CLI::App& app);
Run add_atlas(CLI::App& app);
Run add_render(CLI::App& app);
Run add_compare(CLI::App& app);
Run add_pack(CLI::App& app);
Run add_encode(CLI::App& app);
Run add_check(CLI::App& app);
Run add_inspect(CLI::App& app);

// Values that several commands parse -------------------------------------------------------------------------------

// Checks of a number; unlike CLI11's own they refuse "nan".
CLI::Validator between(double low, double high);
CLI::Validator not_negative();
// Of a text: an option that is given says something.
CLI::Validator not_empty();

// "1,2,3" -> Vec3. Error: usage.
Result<Vec3> parse_vec3(const std::string& text, const std::string& option);
// "640x360" -> width, height, each 1..16384. Error: usage.
struct Size {
    std::uint32_t width = 0, height = 0;
};
Result<Size> parse_size(const std::string& text, const std::string& option);
// "4G", "512M", "100000". Error: usage.
Result<std::uint64_t> parse_bytes(const std::string& text, const std::string& option);

// How many texels, on which pages, and which charts: common to bake and atlas.
class TexelOptions {
public:
    void declare(CLI::App& app);
    // Fills preset, density, resolution, largest page, TEXCOORD_1, lookups and reads the layout to keep. Errors: usage,
    // and
    // those of the file.
    Status read(BakeOptions& options) const;

private:
    std::string preset_ = "medium", resolution_, uv1_ = "automatic", atlas_, filter_ = "bilinear", pages_ = "auto";
    std::uint32_t mips_ = 0, block_ = 1;
    const CLI::Option *filter_option_ = nullptr, *mips_option_ = nullptr, *block_option_ = nullptr;
    BakeOptions values_;
};

// Light and transport options, common to bake and render.
class LightOptions {
public:
    // usual_samples: what the help says of --samples where it is not given.
    void declare(CLI::App& app, const std::string& usual_samples);
    // Fills sky, sun, include, scales, samples, bounces, seed, threads.
    Status read(BakeOptions& options) const;
    // Where none of sky and sun was given, takes those of a bake; so, each by itself, include and the scales. Returns
    // what was taken as it would be given: empty where that makes no difference.
    std::string take_over(const LightRecord& bake, BakeOptions& options) const;

private:
    std::vector<const CLI::Option*> sky_and_sun_;
    const CLI::Option *include_option_ = nullptr, *direct_scale_ = nullptr, *indirect_scale_ = nullptr;
    std::string sky_, sun_direction_, sun_color_ = "1,1,1", include_ = "direct,sky,indirect";
    BakeOptions values_;
};

// How much of a layout stayed.
void print_kept(std::uint64_t kept, std::uint64_t charts, const AtlasRecord& record);

class Interrupt;

// How progress is shown.
enum class ProgressStyle { automatic, plain, json, none };
void declare_progress(CLI::App& app, std::string& style);

// A Context with progress on standard error and Ctrl-C bound to request_cancel() for its lifetime.
class RunContext {
public:
    RunContext(unsigned threads, const std::string& progress_style);
    ~RunContext();
    RunContext(const RunContext&) = delete;
    RunContext& operator=(const RunContext&) = delete;
    [[nodiscard]] Context& get() { return context_; }
    [[nodiscard]] Interrupt& interrupt() { return *interrupt_; }
    // Ends the progress line, prints warnings; at the latest when this goes, for why a run failed may be among them.
    void finish();

private:
    class Meter;
    Context context_;
    std::unique_ptr<Meter> meter_;
    std::unique_ptr<Interrupt> interrupt_;
    bool finished_ = false;
};

}  // namespace lumel::cli
