// A progress line with rate and time left on a terminal, plain lines elsewhere, JSON lines on request.
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "command.h"
#include "interrupt.h"
#include "stage_clock.h"

namespace lumel::cli {
namespace {

std::string duration(double seconds) {
    char text[32];
    if (seconds < 100.0)
        std::snprintf(text, sizeof text, "%.0f s", seconds);
    else if (seconds < 6000.0)
        std::snprintf(text, sizeof text, "%d min %02d s", static_cast<int>(seconds) / 60,
                      static_cast<int>(seconds) % 60);
    else
        std::snprintf(text, sizeof text, "%d h %02d min", static_cast<int>(seconds) / 3600,
                      static_cast<int>(seconds) / 60 % 60);
    return text;
}

std::string left_text(double fraction, double seconds) {
    return fraction > 0.0 ? duration(seconds) + " left" : "time left unknown";
}

std::string rate_text(std::uint64_t rays, double mega_per_second) {
    char text[48] = "";
    if (rays > 0) std::snprintf(text, sizeof text, ", %.1f Mrays/s", mega_per_second);
    return text;
}

}  // namespace

class RunContext::Meter {
public:
    explicit Meter(const std::string& style)
        : style_(style == "json"    ? ProgressStyle::json
                 : style == "none"  ? ProgressStyle::none
                 : style == "plain" ? ProgressStyle::plain
                 : isatty(2)        ? ProgressStyle::automatic
                                    : ProgressStyle::plain) {}

    void show(const Progress& progress) {
        const bool resumed = progress.stage != name_;
        if (resumed) {
            end_line();
            name_ = progress.stage;
        }
        const bool done = progress.fraction >= 1.0;
        Stage& stage = clock_.report(name_, progress.fraction, Clock::now());
        // A bar appears at once, a line only where the stage takes long.
        const bool is_due = style_ == ProgressStyle::plain ? stage.seconds - stage.shown >= 5.0
                                                           : resumed || stage.seconds - stage.shown >= 0.1;
        if (stage.finished || (!done && !is_due)) return;
        stage.shown = stage.seconds;
        stage.finished = done;
        const double elapsed = stage.seconds;
        const double left = stage.seconds_left(progress.fraction);
        const double rate = stage.per_second(static_cast<double>(progress.rays)) * 1e-6;
        switch (style_) {
            case ProgressStyle::none: break;
            case ProgressStyle::json:
                std::fprintf(
                    stderr,
                    "{\"stage\":\"%s\",\"fraction\":%.4f,\"seconds\":%.2f,\"seconds_left\":%.2f,\"rays\":%llu}\n",
                    name_.c_str(), progress.fraction, elapsed, left, static_cast<unsigned long long>(progress.rays));
                break;
            case ProgressStyle::plain:
                if (done && elapsed < 0.5) break;
                std::fprintf(stderr, "%s: %.0f %%, %s%s%s\n", name_.c_str(), 100.0 * progress.fraction,
                             duration(elapsed).c_str(), rate_text(progress.rays, rate).c_str(),
                             done ? "" : (", " + left_text(progress.fraction, left)).c_str());
                break;
            case ProgressStyle::automatic: bar(progress, elapsed, left, rate); break;
        }
    }

    void end_line() {
        if (open_line_) std::fputc('\n', stderr);
        open_line_ = false;
    }

private:
    using Clock = std::chrono::steady_clock;

    void bar(const Progress& progress, double elapsed, double left, double rate) {
        constexpr int kCells = 30;
        const int filled = static_cast<int>(std::lround(progress.fraction * kCells));
        std::string cells(static_cast<std::size_t>(filled), '#');
        cells.resize(kCells, '.');
        std::fprintf(stderr, "\r\033[K%-12s [%s] %3.0f %%%s, %s", name_.c_str(), cells.c_str(),
                     100.0 * progress.fraction, rate_text(progress.rays, rate).c_str(),
                     progress.fraction >= 1.0 ? duration(elapsed).c_str() : left_text(progress.fraction, left).c_str());
        std::fflush(stderr);
        open_line_ = true;
    }

    ProgressStyle style_;
    StageClock clock_{Clock::now()};
    std::string name_;  // of the stage that runs
    bool open_line_ = false;
};

void declare_progress(CLI::App& app, std::string& style) {
    style = "auto";
    app.add_option("--progress", style,
                   "auto: a bar on a terminal, else plain; plain: lines of text; json: an object a line; none")
        ->check(CLI::IsMember({"auto", "plain", "json", "none"}));
}

RunContext::RunContext(unsigned threads, const std::string& progress_style)
    : context_(threads), meter_(std::make_unique<Meter>(progress_style)) {
    context_.on_progress = [this](const Progress& progress) { meter_->show(progress); };
    interrupt_ = std::make_unique<Interrupt>(context_);
}

RunContext::~RunContext() { finish(); }

void RunContext::finish() {
    if (finished_) return;
    finished_ = true;
    meter_->end_line();
    for (const Diagnostic& item : context_.diagnostics.all()) {
        std::fprintf(stderr, "lumel: warning: %s [%s, %llu]", item.message.c_str(), item.code.c_str(),
                     static_cast<unsigned long long>(item.count));
        for (std::size_t i = 0; i < item.examples.size() && i < 3; ++i)
            std::fprintf(stderr, "%s %s", i ? "," : ":", item.examples[i].c_str());
        std::fputc('\n', stderr);
    }
}

int fail(const Error& failure, const std::string& command) {
    Error error = failure;
    if (error.code == ErrorCode::cancelled) {
        std::fprintf(stderr, "%s\n", kCancelledText);
        return kFailed;
    }
    if (error.code == ErrorCode::usage && error.remedy.empty())
        error.remedy = "see lumel " + (command.empty() ? "" : command + " ") + "--help";
    std::fprintf(stderr, "lumel: error: %s\n", error.text().c_str());
    return error.code == ErrorCode::usage ? kUsage : kFailed;
}

}  // namespace lumel::cli
