// The files of `lumel encode` in a folder: pages in an encoding and the JSON that describes them, all of one encoding
// or none.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/encoded_page.h"
#include "io/file_set.h"
#include "io/light_record.h"

namespace lumel {

class EncodedOutput {
public:
    // Makes the folder as needed, and in it one for what is not finished, which goes with this.
    static Result<EncodedOutput> create(const std::filesystem::path& folder, const Encoding& encoding,
                                        const LightRecord& record);

    // Where unfinished files are.
    [[nodiscard]] const std::filesystem::path& partial() const { return files_.partial(); }

    // Writes the next page.
    Status page(const EncodedPage& page, Context& context);

    // Moves all into place, the JSON last: a reader who finds it finds the pages that it names. Pages of an older run
    // that are more than these go. An error where the bake was replaced since its masters were listed.
    Status commit(const MasterList& source);

private:
    struct Page {
        std::string file, type;
        std::uint32_t width, height;
    };
    EncodedOutput(FileSet files, const Encoding& encoding, LightRecord record)
        : files_(std::move(files)), encoding_(&encoding), record_(std::move(record)) {}
    [[nodiscard]] std::string json() const;

    FileSet files_;
    const Encoding* encoding_;
    LightRecord record_;
    std::vector<Page> pages_;
};

}  // namespace lumel
