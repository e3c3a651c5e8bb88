#include "base/memory_use.h"

#include <sys/resource.h>

#include <fstream>
#include <string>

namespace lumel {

// getrusage() keeps the mark of the process across exec(): a small program started by a large one has its peak. Linux
// says better.
std::uint64_t peak_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key;) {
        std::uint64_t kilobytes = 0;
        if (key == "VmHWM:" && status >> kilobytes) return kilobytes * 1024u;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024u;
}

std::string megabytes(std::uint64_t bytes) {
    const std::uint64_t whole = bytes >> 20;
    return std::to_string(whole + ((bytes & 0xfffffu) != 0 ? 1 : 0)) + " MB";
}

}  // namespace lumel
