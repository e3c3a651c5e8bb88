// Fills the corpus folder named on libFuzzer's command line with seeds made in code, once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace lumel::fuzz {

using Seeds = std::vector<std::vector<std::byte>>;

inline std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

// Call from LLVMFuzzerInitialize. The first argument that is no option is the corpus.
inline void seed_corpus(int argc, char** argv, const Seeds& seeds) {
    for (int i = 1; i < argc; ++i) {
        const std::filesystem::path folder = argv[i];
        if (argv[i][0] == '-') continue;
        std::error_code error;
        if (!std::filesystem::is_directory(folder, error)) return;
        for (std::size_t s = 0; s < seeds.size(); ++s) {
            const auto path = folder / ("seed-" + std::to_string(s));
            if (std::filesystem::exists(path, error)) continue;
            std::ofstream(path, std::ios::binary)
                .write(reinterpret_cast<const char*>(seeds[s].data()), static_cast<std::streamsize>(seeds[s].size()));
        }
        return;
    }
}

inline std::span<const std::byte> as_span(const std::uint8_t* data, std::size_t size) {
    return std::as_bytes(std::span(data, size));
}

}  // namespace lumel::fuzz
