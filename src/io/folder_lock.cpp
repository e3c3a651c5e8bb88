#include "io/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

namespace lumel {

namespace fs = std::filesystem;

FolderLock::FolderLock(FolderLock&& other) noexcept : folder_(std::exchange(other.folder_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
    if (this != &other) release();
    folder_ = std::exchange(other.folder_, folder_);
    return *this;
}

FolderLock::~FolderLock() { release(); }

void FolderLock::release() noexcept {
    if (folder_ >= 0) ::close(folder_);
    folder_ = -1;
}

FolderLock::State FolderLock::acquire(const fs::path& folder) {
    release();
    folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ < 0) return State::unsupported;
    if (::flock(folder_, LOCK_EX | LOCK_NB) == 0) return State::held;
    const bool taken = errno == EWOULDBLOCK;
    release();
    return taken ? State::taken : State::unsupported;
}

bool FolderLock::is_of(const fs::path& folder) const {
    struct stat locked {
    }, there{};
    return ::fstat(folder_, &locked) == 0 && ::stat(folder.c_str(), &there) == 0 && locked.st_dev == there.st_dev &&
           locked.st_ino == there.st_ino;
}

Result<FolderLock> lock_folder(const fs::path& folder) {
    FolderLock lock;
    for (int tenths = 0; tenths < 100; ++tenths) {
        if (lock.acquire(folder) != FolderLock::State::taken) return lock;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return Error{ErrorCode::io, "another process holds a lock on this folder", folder.string(),
                 "wait for the one that moves its files there, or choose another folder with -o"};
}

}  // namespace lumel
