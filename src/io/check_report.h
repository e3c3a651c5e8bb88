// What `lumel check` prints for programs (JSON) and writes for people (an HTML page with pictures).
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "check/checked_bake.h"
#include "check/verdict.h"
#include "io/read_report.h"
#include "lumel/result.h"

namespace lumel {

// All that is told.
struct CheckReport {
    const CheckedBake& bake;
    const SeamCheck& seams;
    const TexelCheck& texels;
    std::span<const Finding> findings;
    const BakeRemarks& remarks;
};

// What would make the bake better, in a sentence; empty where nothing is known to.
std::string advice(const CheckReport& report);

// Its members: docs/cli.md, "check".
std::string check_json(const CheckReport& report);
// One file without others: pages as pictures, tone-mapped, the places of findings in magenta.
std::string check_html(const CheckReport& report, const std::string& title);

}  // namespace lumel
