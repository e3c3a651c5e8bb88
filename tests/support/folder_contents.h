// What lies in a folder, for tests of what is written and what is left.
#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace lumel::test {

inline void put(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

inline std::string text_of(const std::filesystem::path& path) {
    std::string text;
    std::getline(std::ifstream(path), text, '\0');
    return text;
}

inline std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) out.insert(entry.path().filename());
    return out;
}

}  // namespace lumel::test
