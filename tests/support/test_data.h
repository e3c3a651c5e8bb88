// Where the real scenes and maps are that some tests use: in the folder that LUMEL_DATA names, else beside the
// checkout.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace lumel::test {

// Nothing where the file is not there: the test skips itself and says so.
inline std::optional<std::filesystem::path> data_file(const std::filesystem::path& name) {
    const char* variable = std::getenv("LUMEL_DATA");
    const std::filesystem::path folder =
        variable ? std::filesystem::path(variable) : std::filesystem::path(LUMEL_SOURCE_DIR) / "../shared/data";
    std::error_code error;
    if (!std::filesystem::exists(folder / name, error)) return std::nullopt;
    return folder / name;
}

}  // namespace lumel::test
