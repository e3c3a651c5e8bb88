#include "io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace lumel {
namespace {

namespace fs = std::filesystem;

std::string temporary_prefix(const fs::path& path) {
    std::string prefix = ".";
    prefix += path.filename().string();
    prefix += ".partial-" + std::to_string(::getpid()) + "-";
    return prefix;
}

// Beside the target, so that rename() stays within one file system; hidden; `attempt` makes it unique.
fs::path temporary_beside(const fs::path& path, unsigned attempt) {
    return path.parent_path() / (temporary_prefix(path) + std::to_string(attempt));
}

std::string remedy_for(int error_number) {
    switch (error_number) {
        case EACCES:
        case EPERM: return "check the permissions of the folder, or choose another with -o";
        case EROFS: return "the file system is read-only: choose another folder with -o";
        case ENOSPC:
        case EDQUOT: return "free some disk space, or choose another folder with -o";
        case ENOENT:
        case ENOTDIR: return "check that the folder exists";
        case ENAMETOOLONG: return "choose a shorter name";
        default: return {};
    }
}

}  // namespace

Error system_error(const char* doing, const fs::path& path, int error_number) {
    return Error{ErrorCode::io, std::string(doing) + " failed: " + std::generic_category().message(error_number),
                 path.string(), remedy_for(error_number)};
}

bool is_disk_full(const Error& error) {
    return error.message.ends_with(std::generic_category().message(ENOSPC)) ||
           error.message.ends_with(std::generic_category().message(EDQUOT));
}

void remove_temporaries(const fs::path& path) {
    const std::string prefix = temporary_prefix(path);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code error;
    std::vector<fs::path> found;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->path().filename().string().starts_with(prefix)) found.push_back(at->path());
    for (const fs::path& file : found) fs::remove(file, error);
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
    constexpr unsigned kAttempts = 1000;  // names taken by other threads, or left by a killed process of the same id
    int error_number = 0;
    for (unsigned attempt = 0; attempt < kAttempts && descriptor_ < 0; ++attempt) {
        temporary_ = temporary_beside(path_, attempt);
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        error_number = errno;
        if (descriptor_ < 0 && error_number != EEXIST && error_number != EINTR) break;
    }
    if (descriptor_ < 0) fail("creating the file", error_number);
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::fail(const char* doing, int error_number) {
    if (status_.ok()) status_ = system_error(doing, path_, error_number);
}

void AtomicFile::discard() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());
    descriptor_ = -1;
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty() && status_.ok()) {
        // Linux writes at most 2 GB at a time.
        const std::size_t size = std::min<std::size_t>(bytes.size(), std::size_t{1} << 30);
        const ssize_t written = ::pwrite(descriptor_, bytes.data(), size, static_cast<off_t>(position_));
        if (written < 0) {
            if (errno != EINTR) fail("writing", errno);
            continue;
        }
        position_ += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void AtomicFile::seek(std::uint64_t position) { position_ = position; }

Status AtomicFile::commit() {
    // A full disk may only show up when the data is flushed or the file closed.
    if (status_.ok() && ::fsync(descriptor_) != 0 && errno != EINVAL) fail("writing to the disk", errno);
    if (descriptor_ >= 0) {
        if (::close(descriptor_) != 0) fail("closing", errno);
        descriptor_ = -1;
        if (status_.ok() && ::rename(temporary_.c_str(), path_.c_str()) != 0) fail("renaming into place", errno);
        if (!status_.ok()) ::unlink(temporary_.c_str());
    }
    return status_;
}

}  // namespace lumel
