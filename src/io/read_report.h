// What a bake said of itself in its report.json, for those who judge it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"

namespace lumel {

struct BakeRemarks {
    std::vector<Diagnostic> warnings;
    bool seams_solved = false;  // --seams on
};

// None where the folder has no report: not everybody ships it. Errors: io, invalid_input.
Result<BakeRemarks> read_remarks(const std::filesystem::path& folder);
// `where`: the file's name, for messages.
Result<BakeRemarks> parse_remarks(std::string_view report, const std::string& where);

}  // namespace lumel
