// The source tree as files and lines, for tests that read it.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace lumel::test {

inline const std::filesystem::path kSourceTree = LUMEL_SOURCE_DIR;

// Files below `root` with one of the extensions of C and C++, in a fixed order.
inline std::vector<std::filesystem::path> sources_below(const std::filesystem::path& root) {
    std::vector<std::filesystem::path> out;
    for (const std::filesystem::directory_entry& entry : std::filesystem::recursive_directory_iterator(root)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".h" || extension == ".cpp" || extension == ".inl" || extension == ".c")
            out.push_back(entry.path());
    }
    std::sort(out.begin(), out.end());
    return out;
}

inline std::vector<std::string> lines_of(const std::filesystem::path& path) {
    std::ifstream stream(path);
    std::vector<std::string> out;
    for (std::string line; std::getline(stream, line);) out.push_back(line);
    return out;
}

}  // namespace lumel::test
