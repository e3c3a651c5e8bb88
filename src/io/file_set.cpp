#include "io/file_set.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/try.h"
#include "io/atomic_file.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

// What is not finished begins with this, whatever it is: names that nobody else gives, out of sight.
constexpr const char* kHidden = ".lumel-";

FileGroup group_in(const fs::path& folder, const FileSetKind& kind) {
    const std::string json = kind.stem + ".json";
    return {folder,
            folder / (kHidden + kind.stem),
            kind.maker,
            json,
            kind.signature,
            [json, is_member = kind.is_member](const std::string& name) { return name == json || is_member(name); }};
}

}  // namespace

Result<FileSet> FileSet::create(const fs::path& folder, const FileSetKind& kind) {
    std::error_code error;
    const FileGroup group = group_in(folder, kind);
    const bool is_new = !fs::exists(fs::symlink_status(folder, error));
    if (!is_new && !fs::is_directory(folder, error))
        return Error{ErrorCode::io, "is not a folder", folder.string(), "choose another folder with -o"};
    if (is_new) fs::create_directories(folder, error);
    if (error) return system_error("creating the folder", folder, error.value());
    if (::access(folder.c_str(), W_OK | X_OK) != 0) return system_error("writing to the folder", folder, errno);
    {
        LUMEL_TRY(const FolderLock lock, lock_folder(folder));
        LUMEL_TRY_STATUS(recover(group));
        LUMEL_TRY_STATUS(check_not_foreign(group, folder));
    }
    remove_stale_partials(folder, kHidden);
    Result<PartialFolder> partial = PartialFolder::create(
        folder, kHidden + kind.stem, [&](const std::string& number) { return group.is_number_taken(number); });
    if (!partial.ok()) {
        Error known = partial.error();
        known.where = folder.string();  // not a name that the user has never seen
        return known;
    }
    return FileSet(group, is_new, std::move(*partial));
}

FileSet::~FileSet() {
    if (partial().empty()) return;
    partial_.remove();
    std::error_code ignored;
    if (is_new_) fs::remove(group_.folder, ignored);  // only where it is empty
}

std::function<void()> FileSet::cleaner() const {
    return [partial = partial(), folder = group_.folder, is_new = is_new_] {
        remove_while_written(partial);
        std::error_code ignored;
        if (is_new) fs::remove(folder, ignored);
    };
}

Status FileSet::commit(const std::function<Status()>& check) {
    LUMEL_TRY(const FolderLock lock, lock_folder(group_.folder));
    if (check) LUMEL_TRY_STATUS(check());
    return replace_group(group_, partial(), partial_.number());
}

void remove_leftovers(const fs::path& folder) {
    remove_stale_partials(folder, kHidden);
    std::error_code ignored;
    const std::string encoded = kHidden + encoded_stem("");
    std::vector<fs::path> left;
    for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored))
        if (at->path().filename().string().starts_with(encoded)) left.push_back(at->path());
    for (const fs::path& path : left)
        if (path.filename().string().find(kPartial) == std::string::npos) fs::remove_all(path, ignored);
}

}  // namespace lumel
