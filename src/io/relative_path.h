// Paths that a file of an output folder names: found again from wherever the two are moved to together.
#pragma once

#include <filesystem>
#include <string>

namespace lumel {

// As seen from the folder; on another drive, say, no relative path leads there.
inline std::string relative_to(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path out = std::filesystem::proximate(file, folder, error);
    return (error ? file : out).generic_string();
}

// As short as it gets from the working directory.
inline std::string found_from_here(const std::filesystem::path& folder, const std::string& file) {
    std::error_code error;
    const std::filesystem::path path = folder / file, out = std::filesystem::proximate(path, error);
    return (error ? path : out).string();
}

}  // namespace lumel
