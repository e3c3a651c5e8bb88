#include "io/output_folder.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/try.h"
#include "io/atomic_file.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

// Siblings of the target, each with the process id behind it. An older bake is replaced in two steps: its files move
// into kLeaving, which becomes kReplaced once it holds them all; then the new ones move in. So what a killed process
// leaves says how far it got.
constexpr std::string_view kPartial = ".partial-", kLeaving = ".leaving-", kReplaced = ".replaced-";

bool all_digits(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// stem, digits, extension?
bool is_numbered(std::string_view name, std::string_view stem, std::string_view extension) {
    return name.size() > stem.size() + extension.size() && name.substr(0, stem.size()) == stem &&
           name.substr(name.size() - extension.size()) == extension &&
           all_digits(name.substr(stem.size(), name.size() - stem.size() - extension.size()));
}

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

// Siblings of the target that a process of ours made for itself and that is gone: those of the suffix.
std::vector<fs::path> left_behind(const fs::path& target, std::string_view suffix) {
    const std::string prefix = target.filename().string() + std::string(suffix);
    std::error_code error;
    std::vector<fs::path> out;
    for (const fs::path& path : entries(target.parent_path(), error)) {
        const std::string name = path.filename().string();
        if (!is_numbered(name, prefix, "")) continue;
        long process = 0;
        std::from_chars(name.data() + prefix.size(), name.data() + name.size(), process);
        const bool gone = process == ::getpid() || (::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH);
        if (gone) out.push_back(path);
    }
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
    for (const fs::path& file : entries(folder, error))
        if (is_output_file(file.filename().string()))
            return Error{ErrorCode::io, "exists and would be replaced, but no finished bake is in this folder",
                         (target / file.filename()).string(), "choose another folder with -o, or move the file away"};
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
    void undo() noexcept {
        std::error_code ignored;
        for (auto at = done_.rbegin(); at != done_.rend(); ++at) fs::rename(at->second, at->first, ignored);
        done_.clear();
    }

private:
    std::vector<std::pair<fs::path, fs::path>> done_;
};

// Moves what is in a folder back into the target and removes the folder. Nothing is overwritten: a file that is in the
// target already stays in the folder, and so does the folder.
Status put_back(const fs::path& folder, const fs::path& target) {
    std::error_code error;
    for (const fs::path& file : entries(folder, error)) {
        const fs::path place = target / file.filename();
        if (fs::exists(fs::symlink_status(place, error))) continue;
        fs::rename(file, place, error);
        if (error) return folder_error("putting back a file of an interrupted bake", place, error);
    }
    if (error) return folder_error("listing the folder", folder, error);
    fs::remove(folder, error);  // only where it is empty
    return success();
}

void remove_output_files(const fs::path& folder) {
    std::error_code error;
    for (const fs::path& file : entries(folder, error))
        if (is_output_file(file.filename().string())) fs::remove(file, error);
}

// Puts right what a process left that was killed while it moved its files into place. The target is then the older bake
// or the newer one, whole.
Status recover(const fs::path& target) {
    std::error_code error;
    if (!fs::is_directory(target, error)) return success();
    for (const fs::path& leaving : left_behind(target, kLeaving)) LUMEL_TRY_STATUS(put_back(leaving, target));
    for (const fs::path& replaced : left_behind(target, kReplaced)) {
        if (is_a_bake(target)) {  // the manifest comes last: all files of the newer bake are there
            fs::remove_all(replaced, error);
            continue;
        }
        remove_output_files(target);  // of the newer bake: those of the older one had all left
        LUMEL_TRY_STATUS(put_back(replaced, target));
    }
    return success();
}

}  // namespace

bool is_output_file(const std::string& name) {
    if (name == kSceneFile || name == kManifestFile || name == kReportFile) return true;
    if (is_numbered(name, kViewStem, ".png")) return true;
    return std::any_of(std::begin(kPageFiles), std::end(kPageFiles), [&](PageFile kind) {
        const PageFileName pattern = page_file_name(kind);
        return is_numbered(name, pattern.stem, pattern.extension);
    });
}

OutputFolder::OutputFolder(fs::path target, fs::path partial)
    : target_(std::move(target)), partial_(std::move(partial)) {}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : target_(std::move(other.target_)), partial_(std::exchange(other.partial_, {})) {}

OutputFolder& OutputFolder::operator=(OutputFolder&& other) noexcept {
    if (this == &other) return *this;
    discard();
    target_ = std::move(other.target_);
    partial_ = std::exchange(other.partial_, {});
    return *this;
}

OutputFolder::~OutputFolder() { discard(); }

void OutputFolder::discard() noexcept {
    std::error_code ignored;
    if (!partial_.empty()) fs::remove_all(partial_, ignored);
    partial_.clear();
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
    if (fs::exists(status)) LUMEL_TRY_STATUS(recover(real));
    if (fs::exists(status)) LUMEL_TRY_STATUS(check_not_foreign(real, target));
    fs::create_directories(real.parent_path(), error);
    if (error) return folder_error("creating the folder", target, error);
    for (const fs::path& stale : left_behind(real, kPartial)) fs::remove_all(stale, error);
    const fs::path partial = with_suffix(real, std::string(kPartial) + std::to_string(::getpid()));
    fs::create_directory(partial, error);
    if (error) return folder_error("creating the folder", target, error);
    return OutputFolder(real, partial);
}

Status OutputFolder::commit() {
    std::error_code error;
    if (!fs::exists(target_, error)) {
        fs::rename(partial_, target_, error);
        if (error) return folder_error("moving into place", target_, error);
        partial_.clear();
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
    LUMEL_TRY_STATUS(recover(target_));  // of a process that was killed since
    std::error_code error;
    const std::string process = std::to_string(::getpid());
    const fs::path leaving = with_suffix(target_, std::string(kLeaving) + process);
    const fs::path replaced = with_suffix(target_, std::string(kReplaced) + process);
    fs::create_directory(leaving, error);
    if (error) return folder_error("creating the folder", leaving, error);
    Moves moves;
    const auto move_all = [&]() -> Status {
        std::vector<fs::path> old = entries(target_, error);
        std::vector<fs::path> fresh = entries(partial_, error);
        if (error) return folder_error("listing the folder", target_, error);
        const auto is_manifest = [](const fs::path& path) { return path.filename() == kManifestFile; };
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
