// URIs as glTF uses them: data: with base64, or a relative path with %XX escapes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lumel/result.h"

namespace lumel {

[[nodiscard]] inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri, const std::string& where);

// The file that a relative URI names, looked for in `directory`. Errors: another scheme (http:), an absolute path, an
// empty directory (a scene read from memory has no files beside it).
Result<std::filesystem::path> resolve_uri(std::string_view uri, const std::filesystem::path& directory,
                                          const std::string& where);

}  // namespace lumel
