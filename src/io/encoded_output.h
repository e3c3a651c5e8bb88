// The files of `lumel encode` in a folder: pages in an encoding and the JSON that describes them, all of one encoding
// or none.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/encoded_page.h"
#include "io/light_record.h"
#include "io/output_folder.h"

namespace lumel {

class EncodedOutput {
public:
    // Makes the folder as needed, and in it one for what is not finished, which goes with this.
    static Result<EncodedOutput> create(const std::filesystem::path& folder, const Encoding& encoding,
                                        const LightRecord& record);

    // Where unfinished files are.
    [[nodiscard]] const std::filesystem::path& partial() const { return partial_.path(); }

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
    EncodedOutput(std::filesystem::path folder, OutputFolder partial, const Encoding& encoding, LightRecord record)
        : folder_(std::move(folder)), partial_(std::move(partial)), encoding_(&encoding), record_(std::move(record)) {}
    [[nodiscard]] std::string json() const;
    // Of a file in there as the user knows it: by its place.
    [[nodiscard]] Error in_place(Error error) const;
    Status remove_older_pages() const;

    std::filesystem::path folder_;
    OutputFolder partial_;
    const Encoding* encoding_;
    LightRecord record_;
    std::vector<Page> pages_;
};

}  // namespace lumel
