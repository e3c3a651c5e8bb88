// Which chart of a .msk is of which group: what `lumel pack --groups` reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lumel/result.h"

namespace lumel {

struct MaskGroups {
    std::vector<std::uint32_t> group_of;  // beside the charts
    std::uint32_t groups = 0;             // the highest number + 1
};

// A JSON array of as many numbers as there are charts, none above their count. Errors: io, invalid_input: they name the
// chart.
Result<MaskGroups> read_mask_groups(const std::filesystem::path& path, std::size_t charts);
Result<MaskGroups> parse_mask_groups(std::string_view text, std::size_t charts, const std::string& where);

}  // namespace lumel
