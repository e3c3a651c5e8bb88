// Files of one job in a folder that others use, too: a JSON that says what they are, and the files that it names. They
// appear together or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "io/file_group.h"
#include "io/partial_folder.h"

namespace lumel {

// What tells the files of one job from all others in the folder.
struct FileSetKind {
    std::string maker;                                       // for messages: "atlas"
    std::string stem;                                        // of the JSON: <stem>.json
    std::string signature;                                   // FileGroup::signature, of the JSON
    std::function<bool(const std::string& name)> is_member;  // of the files that the JSON names
};

class FileSet {
public:
    // Makes the folder as needed, and in it `.lumel-<stem>.partial-<number>` for what is not finished, which goes with
    // this; so does the folder, if it was made for nothing. What killed processes left is put right first. Errors: io,
    // where the folder cannot be written to, or holds files of these names and no JSON of ours with them.
    static Result<FileSet> create(const std::filesystem::path& folder, const FileSetKind& kind);
    ~FileSet();
    FileSet(FileSet&& other) noexcept = default;
    FileSet& operator=(FileSet&& other) noexcept = default;

    // Where to write.
    [[nodiscard]] const std::filesystem::path& partial() const { return partial_.path(); }
    // The error of a file in there as the user knows it: by its place.
    [[nodiscard]] Error in_place(Error error) const { return partial_.as_in(group_.folder, std::move(error)); }
    // Does what the destructor does, for a process that is about to end itself.
    [[nodiscard]] std::function<void()> cleaner() const;

    // Moves what was written into place, the JSON last: a reader who finds it finds what it names. Files of an older
    // run go. On failure the folder is as it was. `check`, asked while nobody else moves files into the folder, can
    // stop all of it.
    Status commit(const std::function<Status()>& check = {});

private:
    FileSet(FileGroup group, bool is_new, PartialFolder partial)
        : group_(std::move(group)), is_new_(is_new), partial_(std::move(partial)) {}

    FileGroup group_;
    bool is_new_;  // the folder
    PartialFolder partial_;
};

// What killed processes left of any set in a folder whose bake was replaced: unfinished files, and encoded ones of the
// older bake. Only with the folder locked.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace lumel
