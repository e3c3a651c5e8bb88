#include "io/partial_folder.h"

#include <unistd.h>

#include <system_error>
#include <utility>
#include <vector>

#include "io/atomic_file.h"
#include "io/page_files.h"

namespace lumel {

namespace fs = std::filesystem;

PartialFolder::PartialFolder(fs::path path, std::string number, FolderLock lock)
    : path_(std::move(path)), number_(std::move(number)), lock_(std::move(lock)) {}

PartialFolder::PartialFolder(PartialFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), number_(std::move(other.number_)), lock_(std::move(other.lock_)) {}

PartialFolder& PartialFolder::operator=(PartialFolder&& other) noexcept {
    if (this == &other) return *this;
    remove();
    path_ = std::exchange(other.path_, {});
    number_ = std::move(other.number_);
    lock_ = std::move(other.lock_);
    return *this;
}

PartialFolder::~PartialFolder() { remove(); }

void PartialFolder::remove() noexcept {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
    release();
}

void PartialFolder::release() noexcept {
    path_.clear();
    lock_.release();
}

Error PartialFolder::as_in(const fs::path& target, Error error) const {
    const std::string partial = path_.string();
    if (!partial.empty() && error.where.starts_with(partial)) error.where.replace(0, partial.size(), target.string());
    return error;
}

Result<PartialFolder> PartialFolder::create(const fs::path& folder, const std::string& stem,
                                            const std::function<bool(const std::string&)>& is_taken) {
    std::error_code error;
    for (long id = ::getpid();; ++id) {
        const std::string number = std::to_string(id);
        const fs::path path = folder / (stem + std::string(kPartial) + number);
        if (fs::exists(fs::symlink_status(path, error)) || is_taken(number)) continue;
        const bool made = fs::create_directory(path, error);
        if (error) return system_error("creating the folder", folder / stem, error.value());
        // Another process may have taken the same name, or taken the folder for a stale one before it was locked.
        FolderLock lock;
        const FolderLock::State state = lock.acquire(path);
        if (!made || state == FolderLock::State::taken || !fs::exists(path, error)) continue;
        if (state == FolderLock::State::held && !lock.is_of(path)) continue;
        return PartialFolder(path, number, std::move(lock));
    }
}

void remove_while_written(const fs::path& folder) noexcept {
    constexpr int kAttempts = 20;
    std::error_code error;
    for (int attempt = 0; attempt < kAttempts && fs::exists(folder, error); ++attempt) fs::remove_all(folder, error);
}

void remove_stale_partials(const fs::path& folder, std::string_view prefix) {
    std::error_code ignored;
    std::vector<fs::path> partials;
    for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored)) {
        const std::string name = at->path().filename().string();
        const std::size_t suffix = name.rfind(kPartial);
        if (suffix == std::string::npos || !name.starts_with(prefix)) continue;
        if (is_numbered(name, name.substr(0, suffix + kPartial.size()), "")) partials.push_back(at->path());
    }
    for (const fs::path& partial : partials) {
        FolderLock lock;
        if (lock.acquire(partial) == FolderLock::State::held && lock.is_of(partial)) fs::remove_all(partial, ignored);
    }
}

}  // namespace lumel
