#include "bake/stage_timer.h"

#include <sys/resource.h>

#include <utility>

namespace lumel {
namespace {

double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

StageTimer::StageTimer(BakeReport& report, std::string stage)
    : report_(report), stage_(std::move(stage)), cpu_(cpu_seconds()) {}

StageTimer::~StageTimer() {
    const double wall = seconds();
    const double cpu = cpu_seconds() - cpu_;
    for (StageTime& time : report_.stages)
        if (time.stage == stage_) {
            time.wall_seconds += wall;
            time.cpu_seconds += cpu;
            return;
        }
    report_.stages.push_back({stage_, wall, cpu});
}

}  // namespace lumel
