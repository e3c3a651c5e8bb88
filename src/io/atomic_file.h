// A file that appears whole or not at all: written beside its place, flushed to the disk, then renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "lumel/result.h"

namespace lumel {

// The first failure sticks: later writes do nothing and commit() returns it. Without commit(), or after a failure,
// nothing is left behind. POSIX only.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::byte> bytes);
    void seek(std::uint64_t position);  // absolute; for formats that patch a table
    [[nodiscard]] std::uint64_t position() const { return position_; }
    [[nodiscard]] bool ok() const { return status_.ok(); }

    // Flushes, closes and renames. Call once.
    Status commit();

private:
    void fail(const char* doing, int error_number);
    void discard();

    std::filesystem::path path_, temporary_;
    int descriptor_ = -1;
    std::uint64_t position_ = 0;
    Status status_ = success();
};

// What AtomicFiles of this process for `path` have not renamed yet; for a process that is about to end itself.
void remove_temporaries(const std::filesystem::path& path);

// An io error with the system's own words and, for the common causes, what to do about it.
Error system_error(const char* doing, const std::filesystem::path& path, int error_number);
inline Error system_error(const char* doing, const std::filesystem::path& path, const std::error_code& error) {
    return system_error(doing, path, error.value());
}

// Whether such an error says that there was no room left (on the disk, or in the user's share of it).
bool is_disk_full(const Error& error);

}  // namespace lumel
