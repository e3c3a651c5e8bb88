#include "io/mask_groups.h"

#include <algorithm>

#include "base/try.h"
#include "io/image_io.h"
#include "io/json_read.h"

namespace lumel {

Result<MaskGroups> parse_mask_groups(std::string_view text, std::size_t charts, const std::string& where) {
    constexpr const char* kRemedy = "give a JSON array with the group of each chart: 0, 1 ..";
    LUMEL_TRY(const Json root, parse_json(text, where));
    if (!root.is_array() || root.size() != charts)
        return invalid(where, "is no list of the groups of " + std::to_string(charts) + " charts", kRemedy);
    MaskGroups out;
    for (std::size_t c = 0; c < charts; ++c) {
        if (!root[c].is_number_unsigned() || root[c].get<std::uint64_t>() > charts)
            return invalid(where, "the group of chart " + std::to_string(c) + " is no number from 0 to that of charts",
                           kRemedy);
        out.group_of.push_back(root[c].get<std::uint32_t>());
        out.groups = std::max(out.groups, out.group_of.back() + 1);
    }
    return out;
}

Result<MaskGroups> read_mask_groups(const std::filesystem::path& path, std::size_t charts) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxManifest));
    return parse_mask_groups({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, charts, path.string());
}

}  // namespace lumel
