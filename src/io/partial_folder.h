// A folder for what is not finished. It is locked while its process lives, whose death leaves it to whoever comes next.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "io/folder_lock.h"

namespace lumel {

inline constexpr std::string_view kPartial = ".partial-";

class PartialFolder {
public:
    // Makes `<stem>.partial-<number>` in a folder that is there; the number is the process id, or the first one after
    // it that is free of what `is_taken` knows besides. Error: io.
    static Result<PartialFolder> create(const std::filesystem::path& folder, const std::string& stem,
                                        const std::function<bool(const std::string& number)>& is_taken);

    // The folder goes, and with it all that is in it.
    ~PartialFolder();
    PartialFolder(PartialFolder&& other) noexcept;
    PartialFolder& operator=(PartialFolder&& other) noexcept;
    void remove() noexcept;
    // The folder became something else: it stays.
    void release() noexcept;

    // Empty once moved from, removed or released.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] const std::string& number() const { return number_; }
    // The error of a file in there as the user knows it: by its place in `target`.
    [[nodiscard]] Error as_in(const std::filesystem::path& target, Error error) const;

private:
    PartialFolder(std::filesystem::path path, std::string number, FolderLock lock);

    std::filesystem::path path_;
    std::string number_;
    FolderLock lock_;
};

// While other threads may still write into it.
void remove_while_written(const std::filesystem::path& folder) noexcept;

// Removes what killed processes were writing: of the folders in `folder` whose name begins with `prefix` and ends with
// ".partial-<number>" those that nobody has locked. Where the file system knows no locks they stay.
void remove_stale_partials(const std::filesystem::path& folder, std::string_view prefix);

}  // namespace lumel
