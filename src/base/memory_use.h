// What the process takes of the machine's memory.
#pragma once

#include <cstdint>

namespace lumel {

// High-water mark of the resident memory, in bytes: of this program, whatever the one that started it had taken.
std::uint64_t peak_memory();

}  // namespace lumel
