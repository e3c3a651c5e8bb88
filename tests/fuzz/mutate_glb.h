// Changes a .glb within its container: call from LLVMFuzzerCustomMutator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace lumel::fuzz {

inline std::uint32_t read_u32(const std::uint8_t* at) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, 4);
    return value;
}

// Replaces one number of the JSON by one that likes to go wrong.
inline void mutate_number(std::vector<std::uint8_t>& json, unsigned seed) {
    static constexpr const char* kNumbers[] = {"0",
                                               "1",
                                               "2",
                                               "3",
                                               "4",
                                               "255",
                                               "256",
                                               "65535",
                                               "65536",
                                               "2147483647",
                                               "2147483648",
                                               "4294967295",
                                               "4294967296",
                                               "9223372036854775808",
                                               "18446744073709551615",
                                               "-1",
                                               "0.5",
                                               "1e30",
                                               "-1e30",
                                               "1e-30",
                                               "5120",
                                               "5121",
                                               "5123",
                                               "5125",
                                               "5126"};
    std::vector<std::size_t> starts;
    for (std::size_t i = 1; i < json.size(); ++i) {
        const char before = static_cast<char>(json[i - 1]), at = static_cast<char>(json[i]);
        if ((before == ':' || before == ',' || before == '[') && (at == '-' || (at >= '0' && at <= '9')))
            starts.push_back(i);
    }
    if (starts.empty()) return;
    const std::size_t start = starts[seed / 7 % starts.size()];
    std::size_t end = start;
    while (end < json.size() && std::strchr("0123456789.eE+-", json[end]) != nullptr && json[end] != 0) ++end;
    const std::string_view number = kNumbers[seed / 131 % std::size(kNumbers)];
    json.erase(json.begin() + static_cast<std::ptrdiff_t>(start), json.begin() + static_cast<std::ptrdiff_t>(end));
    json.insert(json.begin() + static_cast<std::ptrdiff_t>(start), number.begin(), number.end());
}

// Mutates the JSON or the binary chunk and writes the lengths anew: otherwise hardly a mutant would pass the container.
inline std::size_t mutate_glb(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
    const std::size_t json_size = size >= 20 ? read_u32(data + 12) : 0;
    if (seed % 16 == 0 || size < 20 || json_size > size - 20) return LLVMFuzzerMutate(data, size, max_size);
    std::vector<std::uint8_t> json(data + 20, data + 20 + json_size);
    std::vector<std::uint8_t> binary;
    if (size - 20 - json_size > 8) binary.assign(data + 28 + json_size, data + size);
    std::vector<std::uint8_t>& target = seed % 4 == 1 && !binary.empty() ? binary : json;
    if (seed % 3 == 0) {
        mutate_number(json, seed);
    } else {
        const std::size_t before = target.size();
        target.resize(before + 256);
        target.resize(LLVMFuzzerMutate(target.data(), before, before + 256));
    }
    const auto with_lengths = [](std::vector<std::uint8_t>& out, std::uint32_t type,
                                 const std::vector<std::uint8_t>& chunk) {
        const std::uint32_t words[2] = {static_cast<std::uint32_t>(chunk.size()), type};
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(words);
        out.insert(out.end(), bytes, bytes + 8);
        out.insert(out.end(), chunk.begin(), chunk.end());
    };
    std::vector<std::uint8_t> out(data, data + 12);
    with_lengths(out, 0x4e4f534a, json);
    with_lengths(out, 0x004e4942, binary);
    const auto total = static_cast<std::uint32_t>(out.size());
    std::memcpy(out.data() + 8, &total, 4);
    if (out.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, out.data(), out.size());
    return out.size();
}

}  // namespace lumel::fuzz
