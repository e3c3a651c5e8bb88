// Files that make sense together only, in a folder that others use, too: a manifest that says what they are, and the
// files that it names. An older group is replaced by a newer one whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "lumel/result.h"

namespace lumel {

struct FileGroup {
    std::filesystem::path folder;
    // What is being moved lies in folders of this name, a suffix and a number.
    std::filesystem::path beside;
    std::string maker;      // of its files, for messages: "bake"
    std::string manifest;   // goes first and comes last: a reader who finds it finds all
    std::string signature;  // stands within the first 255 bytes of a manifest that is ours
    std::function<bool(const std::string& name)> is_member;  // could such a file be of the group? The manifest is one

    // Whether the folder holds the group.
    [[nodiscard]] bool is_complete() const;
    // Whether this number is that of a replacement that was not finished.
    [[nodiscard]] bool is_number_taken(const std::string& number) const;
};

// Puts right what a process left that was killed while it replaced the group, which is then the older one or the newer
// one, whole. Only with the folder locked: nobody is then at work on it. Error: io.
Status recover(const FileGroup& group);

// Names of files are common ones: what stands there, and no manifest of ours with it, may be somebody's. Error: io,
// naming the file by its place in `shown`.
Status check_not_foreign(const FileGroup& group, const std::filesystem::path& shown);

// Moves all files in `from` into the folder of the group; those of an older group go. On failure all is as it was.
// Members and what is replaced must be files. Only with the folder locked. Error: io.
Status replace_group(const FileGroup& group, const std::filesystem::path& from, const std::string& number);

}  // namespace lumel
