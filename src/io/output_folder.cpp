#include "io/output_folder.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <string_view>
#include <system_error>

#include "base/try.h"
#include "io/atomic_file.h"
#include "io/encoded_target.h"
#include "io/file_group.h"
#include "io/file_set.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

FileGroup bake_in(const fs::path& target) {
    return {target, target, "bake", kManifestFile, "\"Lumel\"", is_output_file};
}

bool is_encoded_file(const std::string& name) {
    return std::ranges::any_of(list_encodings(), [&](const Encoding* encoding) {
        return name == encoded_stem(encoding->name) + ".json" || is_encoded_page_file(*encoding, name);
    });
}

}  // namespace

bool is_encoded_page_file(const Encoding& encoding, const std::string& name) {
    return is_numbered_with_mip(name, encoded_stem(encoding.name) + "_", ".exr") ||
           is_encoded_texture_file(encoding, name);
}

bool is_output_file(const std::string& name) {
    if (is_encoded_file(name)) return true;
    if (name == kSceneFile || name == kManifestFile || name == kReportFile) return true;
    if (is_numbered(name, kViewStem, ".png")) return true;
    return std::any_of(std::begin(kPageFiles), std::end(kPageFiles),
                       [&](PageFile kind) { return is_page_file(kind, name); });
}

Result<OutputFolder> OutputFolder::create(const fs::path& target) {
    std::error_code error;
    if (target.empty()) return Error{ErrorCode::usage, "the output folder has no name", {}, "give one with -o"};
    // Through links to the real place, so that moving stays within one file system; without a trailing slash.
    fs::path real = fs::weakly_canonical(fs::absolute(target, error), error);
    if (error) return system_error("finding the folder", target, error);
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
        LUMEL_TRY_STATUS(recover(bake_in(real)));
        LUMEL_TRY_STATUS(check_not_foreign(bake_in(real), target));
    }
    fs::create_directories(real.parent_path(), error);
    if (error) return system_error("creating the folder", target, error);
    const std::string name = real.filename().string();
    remove_stale_partials(real.parent_path(), name + std::string(kPartial));
    const FileGroup bake = bake_in(real);
    Result<PartialFolder> partial = PartialFolder::create(
        real.parent_path(), name, [&](const std::string& number) { return bake.is_number_taken(number); });
    if (!partial.ok()) {
        Error known = partial.error();
        known.where = target.string();  // not a name that the user has never seen
        return known;
    }
    return OutputFolder(real, std::move(*partial));
}

Status OutputFolder::commit() {
    std::error_code error;
    if (!fs::exists(target_, error)) {
        fs::rename(path(), target_, error);
        if (error) return system_error("moving into place", target_, error);
        partial_.release();
        return success();
    }
    LUMEL_TRY_STATUS(replace_files());
    partial_.remove();
    return success();
}

Status OutputFolder::replace_files() {
    LUMEL_TRY(const FolderLock lock, lock_folder(target_));
    LUMEL_TRY_STATUS(replace_group(bake_in(target_), path(), partial_.number()));
    remove_leftovers(target_);
    return success();
}

}  // namespace lumel
