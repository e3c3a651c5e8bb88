// Files of one job in a folder that others use, too: a JSON that says what they are, and the files that it names. They
// appear together or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "io/output_folder.h"

namespace lumel {

class FileSet {
public:
    // Makes the folder as needed, and in it one named by `stem` for what is not finished, which goes with this; so does
    // the folder, if it was made for nothing.
    static Result<FileSet> create(const std::filesystem::path& folder, const std::string& stem);
    ~FileSet();
    FileSet(FileSet&& other) noexcept = default;
    FileSet& operator=(FileSet&& other) noexcept = default;

    // Where to write.
    [[nodiscard]] const std::filesystem::path& partial() const { return partial_.path(); }
    // The error of a file in there as the user knows it: by its place.
    [[nodiscard]] Error in_place(Error error) const;

    // Moves the files into place, `json` last: a reader who finds it finds what it names. Other files for which
    // `is_member` holds are those of an older run and go. `check`, asked while nobody else moves files into the folder,
    // can stop all of it.
    Status commit(const std::string& json, std::span<const std::string> files,
                  const std::function<bool(const std::string&)>& is_member, const std::function<Status()>& check = {});

private:
    FileSet(std::filesystem::path folder, bool is_new, OutputFolder partial)
        : folder_(std::move(folder)), is_new_(is_new), partial_(std::move(partial)) {}
    [[nodiscard]] Status remove_older(std::span<const std::string> files,
                                      const std::function<bool(const std::string&)>& is_member) const;

    std::filesystem::path folder_;
    bool is_new_;
    OutputFolder partial_;
};

}  // namespace lumel
