#include "io/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/try.h"
#include "io/atomic_file.h"
#include "io/encoded_target.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

// Siblings of the target, each with a number behind it. An older bake is replaced in two steps: its files move into
// kLeaving, which becomes kReplaced once it holds them all; then the new ones move in. So what a killed process leaves
// says how far it got: kLeaving is to be put back, kReplaced only where the newer bake has no manifest yet.
constexpr std::string_view kPartial = ".partial-", kLeaving = ".leaving-", kReplaced = ".replaced-";

Error folder_error(const char* doing, const fs::path& path, const std::error_code& error) {
    return system_error(doing, path, error.value());
}

fs::path with_suffix(const fs::path& target, std::string_view suffix) {
    std::string name = target.filename().string();
    name += suffix;
    return target.parent_path() / name;
}

std::vector<fs::path> entries(const fs::path& folder, std::error_code& error) {
    std::vector<fs::path> out;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        out.push_back(at->path());
    std::sort(out.begin(), out.end());
    return out;
}

// Siblings of the target that have this suffix and a number.
std::vector<fs::path> numbered_siblings(const fs::path& target, std::string_view suffix) {
    const std::string prefix = target.filename().string() + std::string(suffix);
    std::error_code error;
    std::vector<fs::path> out = entries(target.parent_path(), error);
    std::erase_if(out, [&](const fs::path& path) { return !is_numbered(path.filename().string(), prefix, ""); });
    return out;
}

// manifest.json goes first and says near its beginning who wrote it.
bool is_a_bake(const fs::path& folder) {
    char head[256] = {};
    std::ifstream(folder / kManifestFile, std::ios::binary).read(head, sizeof head - 1);
    return std::string_view(head).find("\"Lumel\"") != std::string_view::npos;
}

// Names that a bake gives its files are common ones: what stands there may be somebody's scene.
Status check_not_foreign(const fs::path& folder, const fs::path& target) {
    if (is_a_bake(folder)) return success();
    std::error_code error;
    std::string remedy = "choose another folder with -o, or move the file away";
    for (const fs::path& leaving : numbered_siblings(folder, kLeaving))
        remedy += "; what an interrupted bake left of an older one is in " + leaving.string();
    for (const fs::path& file : entries(folder, error))
        if (is_output_file(file.filename().string()))
            return Error{ErrorCode::io, "exists and would be replaced, but no finished bake is in this folder",
                         (target / file.filename()).string(), remedy};
    if (error) return folder_error("listing the folder", target, error);
    return success();
}

// Moves files one by one and can take all of it back.
class Moves {
public:
    Status move(const fs::path& from, const fs::path& to) {
        std::error_code error;
        fs::rename(from, to, error);
        if (error) return folder_error("moving into place", to, error);
        done_.emplace_back(from, to);
        return success();
    }
    // Ends where a move fails: what is left then is what recover() knows how to put right.
    void undo() noexcept {
        std::error_code error;
        for (auto at = done_.rbegin(); at != done_.rend() && !error; ++at) fs::rename(at->second, at->first, error);
        done_.clear();
    }

private:
    std::vector<std::pair<fs::path, fs::path>> done_;
};

bool is_manifest(const fs::path& path) { return path.filename() == kManifestFile; }

// Moves what is in a folder back into the target and removes the folder. Nothing is overwritten: a file that is in the
// target already stays in the folder, and so does the folder. The manifest comes last: until then this can be done
// again.
Status put_back(const fs::path& folder, const fs::path& target) {
    std::error_code error;
    std::vector<fs::path> files = entries(folder, error);
    if (error) return folder_error("listing the folder", folder, error);
    std::stable_partition(files.begin(), files.end(), std::not_fn(is_manifest));
    for (const fs::path& file : files) {
        const fs::path place = target / file.filename();
        if (fs::exists(fs::symlink_status(place, error))) continue;
        fs::rename(file, place, error);
        if (error) return folder_error("putting back a file of an interrupted bake", place, error);
    }
    fs::remove(folder, error);  // only where it is empty
    return success();
}

Status remove_output_files(const fs::path& folder) {
    std::error_code error;
    for (const fs::path& file : entries(folder, error)) {
        if (is_output_file(file.filename().string())) fs::remove(file, error);
        if (error) return folder_error("removing a file of an interrupted bake", file, error);
    }
    if (error) return folder_error("listing the folder", folder, error);
    return success();
}

// Puts right what a process left that was killed while it moved its files into place. The target is then the older bake
// or the newer one, whole. This may be killed as well: every step leaves what the next recovery takes up. Only with the
// target locked: then nobody is at work on what stands beside it.
Status recover(const fs::path& target) {
    std::error_code error;
    for (const fs::path& replaced : numbered_siblings(target, kReplaced)) {
        if (is_a_bake(target)) {  // the manifest comes last: all files of the newer bake are there
            fs::remove_all(replaced, error);
            continue;
        }
        LUMEL_TRY_STATUS(remove_output_files(target));  // of the newer bake: those of the older one had all left
        // From here on what is in the target is of the older bake.
        std::string name = replaced.filename().string();
        name.replace(target.filename().string().size(), kReplaced.size(), kLeaving);
        fs::rename(replaced, replaced.parent_path() / name, error);
        if (error) return folder_error("putting back an interrupted bake", replaced, error);
    }
    for (const fs::path& leaving : numbered_siblings(target, kLeaving)) {
        if (is_a_bake(target))
            fs::remove(leaving, error);  // only where it is empty: else it is what could not be put back
        else
            LUMEL_TRY_STATUS(put_back(leaving, target));
    }
    return success();
}

// Removes what killed processes were writing: the partial folders that nobody has locked. Where the file system knows
// no locks they stay.
void remove_stale_partials(const fs::path& target) {
    std::error_code ignored;
    for (const fs::path& partial : numbered_siblings(target, kPartial)) {
        FolderLock lock;
        if (lock.acquire(partial) == FolderLock::State::held && lock.is_of(partial)) fs::remove_all(partial, ignored);
    }
}

// The process id, or the first number after it whose names are free: in containers many processes have the same id.
std::string free_number(const fs::path& target) {
    const auto is_taken = [&](const std::string& number) {
        std::error_code error;
        for (const std::string_view suffix : {kPartial, kLeaving, kReplaced})
            if (fs::exists(fs::symlink_status(with_suffix(target, std::string(suffix) + number), error))) return true;
        return false;
    };
    long number = ::getpid();
    while (is_taken(std::to_string(number))) ++number;
    return std::to_string(number);
}

bool is_encoded_file(const std::string& name) {
    return std::ranges::any_of(list_encodings(), [&](const Encoding* encoding) {
        return name == encoded_stem(encoding->name) + ".json" || is_encoded_page_file(*encoding, name);
    });
}

}  // namespace

Result<FolderLock> lock_folder(const fs::path& folder) {
    FolderLock lock;
    for (int tenths = 0; tenths < 100; ++tenths) {
        if (lock.acquire(folder) != FolderLock::State::taken) return lock;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return Error{ErrorCode::io, "another process holds a lock on this folder", folder.string(),
                 "wait for the one that moves its files there, or choose another folder with -o"};
}

bool is_encoded_page_file(const Encoding& encoding, const std::string& name) {
    return is_numbered(name, encoded_stem(encoding.name) + "_", ".exr") || is_encoded_texture_file(encoding, name);
}

bool is_output_file(const std::string& name) {
    if (is_encoded_file(name)) return true;
    if (name == kSceneFile || name == kManifestFile || name == kReportFile) return true;
    if (is_numbered(name, kViewStem, ".png")) return true;
    return std::any_of(std::begin(kPageFiles), std::end(kPageFiles), [&](PageFile kind) {
        const PageFileName pattern = page_file_name(kind);
        return is_numbered(name, pattern.stem, pattern.extension);
    });
}

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

OutputFolder::OutputFolder(fs::path target, fs::path partial, std::string number, FolderLock lock)
    : target_(std::move(target)), partial_(std::move(partial)), number_(std::move(number)), lock_(std::move(lock)) {}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : target_(std::move(other.target_)),
      partial_(std::exchange(other.partial_, {})),
      number_(std::move(other.number_)),
      lock_(std::move(other.lock_)) {}

OutputFolder& OutputFolder::operator=(OutputFolder&& other) noexcept {
    if (this == &other) return *this;
    discard();
    target_ = std::move(other.target_);
    partial_ = std::exchange(other.partial_, {});
    number_ = std::move(other.number_);
    lock_ = std::move(other.lock_);
    return *this;
}

OutputFolder::~OutputFolder() { discard(); }

void OutputFolder::discard() noexcept {
    std::error_code ignored;
    if (!partial_.empty()) fs::remove_all(partial_, ignored);
    partial_.clear();
    lock_.release();
}

Result<OutputFolder> OutputFolder::create(const fs::path& target) {
    std::error_code error;
    if (target.empty()) return Error{ErrorCode::usage, "the output folder has no name", {}, "give one with -o"};
    // Through links to the real place, so that moving stays within one file system; without a trailing slash.
    fs::path real = fs::weakly_canonical(fs::absolute(target, error), error);
    if (error) return folder_error("finding the folder", target, error);
    if (real.filename().empty()) real = real.parent_path();
    const fs::file_status status = fs::status(real, error);
    if (fs::exists(status) && !fs::is_directory(status))
        return Error{ErrorCode::io, "is not a folder", target.string(), "choose another folder with -o"};
    if (real == real.root_path())
        return Error{ErrorCode::io, "is the root folder", target.string(), "choose another folder with -o"};
    if (fs::exists(status) && ::access(real.c_str(), W_OK | X_OK) != 0)
        return system_error("writing to the folder", target, errno);
    if (fs::exists(status)) {
        LUMEL_TRY(const FolderLock lock, lock_folder(real));
        LUMEL_TRY_STATUS(recover(real));
        LUMEL_TRY_STATUS(check_not_foreign(real, target));
    }
    fs::create_directories(real.parent_path(), error);
    if (error) return folder_error("creating the folder", target, error);
    remove_stale_partials(real);
    for (;;) {
        const std::string number = free_number(real);
        const fs::path partial = with_suffix(real, std::string(kPartial) + number);
        const bool made = fs::create_directory(partial, error);
        if (error) return folder_error("creating the folder", target, error);
        // Another process may have taken the same name, or taken the folder for a stale one before it was locked.
        FolderLock lock;
        const FolderLock::State state = lock.acquire(partial);
        if (!made || state == FolderLock::State::taken || !fs::exists(partial, error)) continue;
        if (state == FolderLock::State::held && !lock.is_of(partial)) continue;
        return OutputFolder(real, partial, number, std::move(lock));
    }
}

Status OutputFolder::commit() {
    std::error_code error;
    if (!fs::exists(target_, error)) {
        fs::rename(partial_, target_, error);
        if (error) return folder_error("moving into place", target_, error);
        partial_.clear();
        lock_.release();
        return success();
    }
    LUMEL_TRY_STATUS(replace_files());
    discard();
    return success();
}

Error OutputFolder::as_in_target(Error error) const {
    const std::string partial = partial_.string();
    if (!partial.empty() && error.where.starts_with(partial)) error.where.replace(0, partial.size(), target_.string());
    return error;
}

Status OutputFolder::replace_files() {
    LUMEL_TRY(const FolderLock lock, lock_folder(target_));
    LUMEL_TRY_STATUS(recover(target_));  // of a process that was killed since
    std::error_code error;
    const fs::path leaving = with_suffix(target_, std::string(kLeaving) + number_);
    const fs::path replaced = with_suffix(target_, std::string(kReplaced) + number_);
    fs::create_directory(leaving, error);
    if (error) return folder_error("creating the folder", leaving, error);
    Moves moves;
    const auto move_all = [&]() -> Status {
        std::vector<fs::path> old = entries(target_, error);
        std::vector<fs::path> fresh = entries(partial_, error);
        if (error) return folder_error("listing the folder", target_, error);
        std::stable_partition(old.begin(), old.end(), is_manifest);
        std::stable_partition(fresh.begin(), fresh.end(), std::not_fn(is_manifest));
        for (const fs::path& file : old)
            if (is_output_file(file.filename().string())) LUMEL_TRY_STATUS(moves.move(file, leaving / file.filename()));
        LUMEL_TRY_STATUS(moves.move(leaving, replaced));
        for (const fs::path& file : fresh) LUMEL_TRY_STATUS(moves.move(file, target_ / file.filename()));
        return success();
    };
    const Status status = move_all();
    if (!status.ok()) {
        moves.undo();
        fs::remove(leaving, error);  // only where it is empty: what could not be moved back is still there
        return status;
    }
    fs::remove_all(replaced, error);
    return success();
}

}  // namespace lumel
