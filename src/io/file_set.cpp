#include "io/file_set.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/try.h"
#include "io/atomic_file.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

Status move_file(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) return system_error("moving into place", to, error.value());
    return success();
}

// The partial folder of a FileSet is of no interest by now.
void remove_if_empty(const fs::path& folder, OutputFolder& partial) {
    { const OutputFolder gone(std::move(partial)); }
    std::error_code ignored;
    fs::remove(folder, ignored);
}

}  // namespace

Result<FileSet> FileSet::create(const fs::path& folder, const std::string& stem) {
    std::error_code error;
    const bool is_new = !fs::exists(fs::symlink_status(folder, error));
    LUMEL_TRY(OutputFolder partial, OutputFolder::create(folder / stem));
    return FileSet(folder, is_new, std::move(partial));
}

FileSet::~FileSet() {
    if (is_new_ && !partial_.path().empty()) remove_if_empty(folder_, partial_);
}

Error FileSet::in_place(Error error) const {
    const std::string unfinished = partial().string();
    if (error.where.starts_with(unfinished)) error.where.replace(0, unfinished.size(), folder_.string());
    return error;
}

Status FileSet::remove_older(std::span<const std::string> files,
                             const std::function<bool(const std::string&)>& is_member) const {
    std::error_code error;
    std::vector<fs::path> older;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (is_member(name) && std::ranges::find(files, name) == files.end()) older.push_back(at->path());
    }
    if (error) return system_error("listing the folder", folder_, error.value());
    for (const fs::path& file : older)
        if (fs::remove(file, error); error) return system_error("removing an older page", file, error.value());
    return success();
}

Status FileSet::commit(const std::string& json, std::span<const std::string> files,
                       const std::function<bool(const std::string&)>& is_member, const std::function<Status()>& check) {
    LUMEL_TRY(const FolderLock lock, lock_folder(folder_));
    if (check) LUMEL_TRY_STATUS(check());
    std::error_code error;
    fs::remove(folder_ / json, error);
    if (error) return system_error("replacing the file", folder_ / json, error.value());
    for (const std::string& file : files) LUMEL_TRY_STATUS(move_file(partial() / file, folder_ / file));
    LUMEL_TRY_STATUS(remove_older(files, is_member));
    return move_file(partial() / json, folder_ / json);
}

}  // namespace lumel
