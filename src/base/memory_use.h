// What the process takes of the machine's memory, and how much that is in words.
#pragma once

#include <cstdint>
#include <string>

namespace lumel {

// High-water mark of the resident memory, in bytes: of this program, whatever the one that started it had taken.
std::uint64_t peak_memory();

// "12 MB": rounded up.
std::string megabytes(std::uint64_t bytes);

}  // namespace lumel
