// Locks on folders, by which processes tell what the living are at work on from what the dead left.
#pragma once

#include <cstdint>
#include <filesystem>

#include "lumel/result.h"

namespace lumel {

// An exclusive lock on a folder that ends with the process, however it ends: process ids come back, in containers at
// once. It goes with the folder when that is renamed. On network file systems it is of this host only.
class FolderLock {
public:
    FolderLock() = default;
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&& other) noexcept;

    enum class State : std::uint8_t { held, taken, unsupported };
    State acquire(const std::filesystem::path& folder);  // does not wait
    // Is the locked folder still the one of this path?
    [[nodiscard]] bool is_of(const std::filesystem::path& folder) const;
    void release() noexcept;

private:
    int folder_ = -1;
};

// Holds a folder for as long as it takes to move some files; waits a little for others who do. Where the file system
// knows no locks: as well as one can. Error: io.
Result<FolderLock> lock_folder(const std::filesystem::path& folder);

}  // namespace lumel
