// How long each stage of a run has taken, told from its reports. Some stages come and go, with each page of a bake:
// they go on where they were.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace lumel::cli {

struct Stage {
    double seconds = 0.0, shown = 0.0;  // that it ran, and had run when it was last shown
    bool finished = false;

    [[nodiscard]] double seconds_left(double fraction) const {
        return fraction > 0.0 ? seconds / fraction - seconds : 0.0;
    }
    // Of what was done since it began.
    [[nodiscard]] double per_second(double done) const { return seconds > 0.0 ? done / seconds : 0.0; }
};

class StageClock {
public:
    using Time = std::chrono::steady_clock::time_point;

    explicit StageClock(Time start) : last_(start) {}

    // A stage reported. Reports say what is done: the time since the last one, whichever stage that was of, was spent
    // on it. A finished stage that reports less than all has begun anew.
    Stage& report(std::string_view name, double fraction, Time now) {
        auto at = stages_.find(name);
        if (at == stages_.end()) at = stages_.emplace(name, Stage{}).first;
        Stage& stage = at->second;
        if (stage.finished && fraction < 1.0) stage = {};
        stage.seconds += std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return stage;
    }

private:
    std::map<std::string, Stage, std::less<>> stages_;
    Time last_;
};

}  // namespace lumel::cli
