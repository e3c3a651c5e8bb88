// The files of `lumel encode` in a folder: pages in an encoding and the JSON that describes them, all of one encoding
// or none.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/encoded_page.h"
#include "io/file_set.h"
#include "io/light_record.h"
#include "io/texture_pages.h"

namespace lumel {

class EncodedOutput {
public:
    // Makes the folder as needed, and in it one for what is not finished, which goes with this.
    // Precondition: the storage of the target, if any, holds the encoding.
    static Result<EncodedOutput> create(const std::filesystem::path& folder, const Encoding& encoding,
                                        const LightRecord& record, const EncodedTarget& target = {});

    // Where unfinished files are.
    [[nodiscard]] const std::filesystem::path& partial() const { return files_.partial(); }
    // FileSet::cleaner.
    [[nodiscard]] std::function<void()> cleaner() const { return files_.cleaner(); }

    // Writes the next page, which is followed by its mips.
    Status page(std::span<const EncodedPage> levels, Context& context);

    // Moves all into place, the JSON last: a reader who finds it finds the pages that it names. Files of an older run,
    // in this format or another, go where these do not replace them. An error where the bake was replaced since its
    // masters were listed. Precondition: all layers of the target are there.
    Status commit(const MasterList& source);

    // The JSON and, in order, the pages or textures, each once.
    struct Files {
        std::string description;
        std::vector<std::string> pages;
    };
    [[nodiscard]] Files files() const;

private:
    struct Level {
        std::uint32_t width, height;
        std::string type;  // of EXR
    };
    EncodedOutput(FileSet files, const Encoding& encoding, LightRecord record, const EncodedTarget& target);
    // The type of its light.
    Result<std::string> write_exr_page(const EncodedPage& page, std::uint32_t mip, Context& context);
    [[nodiscard]] std::string json() const;

    FileSet files_;
    const Encoding* encoding_;
    LightRecord record_;
    EncodedTarget target_;
    std::optional<TexturePages> textures_;   // none for EXR
    std::vector<std::vector<Level>> pages_;  // each followed by its mips
};

}  // namespace lumel
