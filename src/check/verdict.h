// The gate: figures of a bake against what is allowed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/seam_check.h"
#include "check/texel_check.h"

namespace lumel {

// What is allowed at most. Below zero: anything is.
struct CheckLimits {
    double seam_p99 = -1.0;                                    // contrast of open seams, of 1
    double seam_visible = -1.0;                                // share of their length above 1 %
    double invalid = 0.05;                                     // filled over covered texels
    double unconverged = -1.0;                                 // share of baked texels
    double outliers = 0.05;                                    // share of the area
    double not_finite = 0.0, uncovered = 0.0, overlaps = 0.0;  // numbers
    double black = -1.0;  // a number; geometry inside each other has some for a reason
};

struct Finding {
    std::string name;    // stable, snake_case: a key in JSON
    std::string text;    // what it is, for people
    std::string option;  // of `lumel check`: its limit
    double value = 0.0, limit = -1.0;
    bool is_share = false;  // shown in percent
    std::vector<TexelDefect> places;
    bool is_measured = true;  // false: there was nothing to measure, and the value is 0

    [[nodiscard]] bool has_limit() const { return limit >= 0.0; }
    [[nodiscard]] bool passed() const { return limit < 0.0 || value <= limit; }
};

// In a fixed order: all figures that can have a limit.
std::vector<Finding> judge(const SeamCheck& seams, const TexelCheck& texels, const CheckLimits& limits);

// "passed: all 6 limits are kept", or which are not.
std::string verdict(std::span<const Finding> findings);

}  // namespace lumel
