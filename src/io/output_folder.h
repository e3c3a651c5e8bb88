// The output folder, whole or not at all: files are written into a sibling of it and moved into place at the end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "encode/encoding.h"
#include "lumel/result.h"

namespace lumel {

// An exclusive lock on a folder that ends with the process, however it ends: process ids come back, in containers at
// once. It goes with the folder when that is renamed. On network file systems it is of this host only.
class FolderLock {
public:
    FolderLock() = default;
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&& other) noexcept;

    enum class State : std::uint8_t { held, taken, unsupported };
    State acquire(const std::filesystem::path& folder);  // does not wait
    // Is the locked folder still the one of this path?
    [[nodiscard]] bool is_of(const std::filesystem::path& folder) const;
    void release() noexcept;

private:
    int folder_ = -1;
};

class OutputFolder {
public:
    // Makes `<target>.partial-<number>` beside the target, and parents as needed; the number is the process id where
    // that is free. The folder is locked while this lives: one without a lock is what a killed process left. What
    // killed processes left is put right first: their partial folders go, and a bake that one of them was about to
    // replace comes back. Errors where the target is no folder, cannot be written to, or holds files of our names that
    // no bake wrote: before hours of work, not after.
    static Result<OutputFolder> create(const std::filesystem::path& target);

    // Without commit() the partial folder goes, and with it all that is in it.
    ~OutputFolder();
    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&& other) noexcept;

    // Where to write.
    [[nodiscard]] const std::filesystem::path& path() const { return partial_; }
    // The error of a file in there as the user knows it: by its place in the target.
    [[nodiscard]] Error as_in_target(Error error) const;

    // Moves everything into place. Files of an older bake (see is_output_file) go, others in the target stay. On
    // failure the target is as it was. A new target appears in one step; in an older one manifest.json goes first and
    // comes last, so that a reader who finds it finds all.
    Status commit();

private:
    OutputFolder(std::filesystem::path target, std::filesystem::path partial, std::string number, FolderLock lock);
    void discard() noexcept;
    Status replace_files();

    std::filesystem::path target_, partial_;  // partial_ is empty once moved from or committed
    std::string number_;
    FolderLock lock_;
};

// Holds a folder for as long as it takes to move some files; waits a little for others who do. Where the file system
// knows no locks: as well as one can. Error: io.
Result<FolderLock> lock_folder(const std::filesystem::path& folder);

// Is this the name of a file that a bake writes, or of one that is made of its files (encode)? Those of an older bake
// go when a new one moves in.
bool is_output_file(const std::string& name);
bool is_encoded_page_file(const Encoding& encoding, const std::string& name);

}  // namespace lumel
