// Time per stage for the report.
#pragma once

#include <string>

#include "base/stopwatch.h"
#include "lumel/bake.h"

namespace lumel {

// Adds the life time of the object to a stage of the report; stages of the same name (one per page) add up.
class StageTimer {
public:
    StageTimer(BakeReport& report, std::string stage);
    ~StageTimer();
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;
    [[nodiscard]] double seconds() const { return wall_.seconds(); }

private:
    BakeReport& report_;
    std::string stage_;
    Stopwatch wall_;
    double cpu_;
};

}  // namespace lumel
