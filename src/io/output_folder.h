// The output folder, whole or not at all: files are written into a sibling of it and moved into place at the end.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "encode/encoding.h"
#include "io/partial_folder.h"
#include "lumel/result.h"

namespace lumel {

class OutputFolder {
public:
    // Makes `<target>.partial-<number>` beside the target, and parents as needed; the number is the process id where
    // that is free. The folder is locked while this lives: one without a lock is what a killed process left. What
    // killed processes left is put right first: their partial folders go, and a bake that one of them was about to
    // replace comes back. Errors where the target is no folder, cannot be written to, or holds files of our names that
    // no bake wrote: before hours of work, not after.
    static Result<OutputFolder> create(const std::filesystem::path& target);

    // Where to write.
    [[nodiscard]] const std::filesystem::path& path() const { return partial_.path(); }
    // The error of a file in there as the user knows it: by its place in the target.
    [[nodiscard]] Error as_in_target(Error error) const { return partial_.as_in(target_, std::move(error)); }

    // Moves everything into place. Files of an older bake (see is_output_file) go, others in the target stay. On
    // failure the target is as it was. A new target appears in one step; in an older one manifest.json goes first and
    // comes last, so that a reader who finds it finds all.
    Status commit();

private:
    OutputFolder(std::filesystem::path target, PartialFolder partial)
        : target_(std::move(target)), partial_(std::move(partial)) {}
    Status replace_files();

    std::filesystem::path target_;
    PartialFolder partial_;  // of no path once moved from or committed
};

// Is this the name of a file that a bake writes, or of one that is made of its files (encode)? Those of an older bake
// go when a new one moves in.
bool is_output_file(const std::string& name);
bool is_encoded_page_file(const Encoding& encoding, const std::string& name);

}  // namespace lumel
