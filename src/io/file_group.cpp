#include "io/file_group.h"

#include <algorithm>
#include <fstream>
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

// An older group is replaced in two steps: its files move into kLeaving, which becomes kReplaced once it holds them
// all; then the new ones move in. So what a killed process leaves says how far it got: kLeaving is to be put back,
// kReplaced only where the newer group has no manifest yet.
constexpr std::string_view kLeaving = ".leaving-", kReplaced = ".replaced-";

std::vector<fs::path> entries(const fs::path& folder, std::error_code& error) {
    std::vector<fs::path> out;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        out.push_back(at->path());
    std::sort(out.begin(), out.end());
    return out;
}

fs::path numbered(const FileGroup& group, std::string_view suffix, const std::string& number) {
    return group.beside.parent_path() / (group.beside.filename().string() + std::string(suffix) + number);
}

// Those of any number.
std::vector<fs::path> all_numbered(const FileGroup& group, std::string_view suffix) {
    const std::string prefix = group.beside.filename().string() + std::string(suffix);
    std::error_code error;
    std::vector<fs::path> out = entries(group.beside.parent_path(), error);
    std::erase_if(out, [&](const fs::path& path) { return !is_numbered(path.filename().string(), prefix, ""); });
    return out;
}

// Moves files one by one and can take all of it back.
class Moves {
public:
    Status move(const fs::path& from, const fs::path& to) {
        std::error_code error;
        fs::rename(from, to, error);
        if (error) return system_error("moving into place", to, error);
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

// Moves what is in a folder back into that of the group and removes the folder. Nothing is overwritten: a file that is
// there already stays in the folder, and so does the folder. The manifest comes last: until then this can be done
// again.
Status put_back(const fs::path& leaving, const FileGroup& group) {
    std::error_code error;
    std::vector<fs::path> files = entries(leaving, error);
    if (error) return system_error("listing the folder", leaving, error);
    std::stable_partition(files.begin(), files.end(),
                          [&](const fs::path& file) { return file.filename() != group.manifest; });
    for (const fs::path& file : files) {
        const fs::path place = group.folder / file.filename();
        if (fs::exists(fs::symlink_status(place, error))) continue;
        fs::rename(file, place, error);
        if (error) return system_error("putting back a file of an interrupted run", place, error);
    }
    fs::remove(leaving, error);  // only where it is empty
    return success();
}

Status remove_members(const FileGroup& group) {
    std::error_code error;
    for (const fs::path& file : entries(group.folder, error)) {
        if (group.is_member(file.filename().string())) fs::remove(file, error);
        if (error) return system_error("removing a file of an interrupted run", file, error);
    }
    if (error) return system_error("listing the folder", group.folder, error);
    return success();
}

// Links are files, too: they are moved, not what they lead to.
Status check_is_file(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (!fs::exists(status) || fs::is_regular_file(status) || fs::is_symlink(status)) return success();
    return Error{ErrorCode::io, "is in the way of a file of this name, and is none", path.string(),
                 "move it away, or choose another folder with -o"};
}

}  // namespace

bool FileGroup::is_complete() const {
    char head[256] = {};
    std::ifstream(folder / manifest, std::ios::binary).read(head, sizeof head - 1);
    return std::string_view(head).find(signature) != std::string_view::npos;
}

bool FileGroup::is_number_taken(const std::string& number) const {
    std::error_code error;
    return fs::exists(fs::symlink_status(numbered(*this, kLeaving, number), error)) ||
           fs::exists(fs::symlink_status(numbered(*this, kReplaced, number), error));
}

// This may be killed as well: every step leaves what the next recovery takes up.
Status recover(const FileGroup& group) {
    std::error_code error;
    for (const fs::path& replaced : all_numbered(group, kReplaced)) {
        if (group.is_complete()) {  // the manifest comes last: all files of the newer group are there
            fs::remove_all(replaced, error);
            continue;
        }
        LUMEL_TRY_STATUS(remove_members(group));  // of the newer group: those of the older one had all left
        // From here on what is in the folder is of the older group.
        const std::string number =
            replaced.filename().string().substr(group.beside.filename().string().size() + kReplaced.size());
        fs::rename(replaced, numbered(group, kLeaving, number), error);
        if (error) return system_error("putting back files of an interrupted run", replaced, error);
    }
    for (const fs::path& leaving : all_numbered(group, kLeaving)) {
        if (group.is_complete())
            fs::remove(leaving, error);  // only where it is empty: else it is what could not be put back
        else
            LUMEL_TRY_STATUS(put_back(leaving, group));
    }
    return success();
}

Status check_not_foreign(const FileGroup& group, const fs::path& shown) {
    if (group.is_complete()) return success();
    std::error_code error;
    std::string remedy = "choose another folder with -o, or move the file away";
    for (const fs::path& leaving : all_numbered(group, kLeaving))
        remedy += "; what an interrupted " + group.maker + " left of an older one is in " + leaving.string();
    for (const fs::path& file : entries(group.folder, error))
        if (group.is_member(file.filename().string()))
            return Error{ErrorCode::io,
                         "exists and would be replaced, but no finished " + group.maker + " is in this folder",
                         (shown / file.filename()).string(), remedy};
    if (error) return system_error("listing the folder", shown, error);
    return success();
}

Status replace_group(const FileGroup& group, const fs::path& from, const std::string& number) {
    LUMEL_TRY_STATUS(recover(group));  // of a process that was killed since
    std::error_code error;
    std::vector<fs::path> old = entries(group.folder, error);
    if (error) return system_error("listing the folder", group.folder, error);
    std::vector<fs::path> fresh = entries(from, error);
    if (error) return system_error("listing the folder", from, error);
    const auto is_manifest = [&](const fs::path& file) { return file.filename() == group.manifest; };
    std::erase_if(old, [&](const fs::path& file) { return !group.is_member(file.filename().string()); });
    std::stable_partition(old.begin(), old.end(), is_manifest);
    std::stable_partition(fresh.begin(), fresh.end(), std::not_fn(is_manifest));
    for (const fs::path& file : old) LUMEL_TRY_STATUS(check_is_file(file));
    for (const fs::path& file : fresh) LUMEL_TRY_STATUS(check_is_file(group.folder / file.filename()));

    const fs::path leaving = numbered(group, kLeaving, number), replaced = numbered(group, kReplaced, number);
    fs::create_directory(leaving, error);
    if (error) return system_error("creating the folder", leaving, error);
    Moves moves;
    const auto move_all = [&]() -> Status {
        for (const fs::path& file : old) LUMEL_TRY_STATUS(moves.move(file, leaving / file.filename()));
        LUMEL_TRY_STATUS(moves.move(leaving, replaced));
        for (const fs::path& file : fresh) LUMEL_TRY_STATUS(moves.move(file, group.folder / file.filename()));
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
