// Time per stage for the report.
#pragma once

#include <chrono>
#include <string>

#include "lumel/bake.h"

namespace lumel {

// Adds the life time of the object to a stage of the report; stages of the same name (one per page) add up.
class StageTimer {
public:
    StageTimer(BakeReport& report, std::string stage);
    ~StageTimer();
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;
    [[nodiscard]] double seconds() const;

private:
    BakeReport& report_;
    std::string stage_;
    std::chrono::steady_clock::time_point wall_;
    double cpu_;
};

}  // namespace lumel
