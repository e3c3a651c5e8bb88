// Pages of an encoding as texture files: KTX2 and DDS, with pages of one size as layers, PNG and Radiance HDR.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "encode/encoded_page.h"
#include "io/encoded_target.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "texture/texture_file.h"

namespace lumel {

class TexturePages {
public:
    // Precondition: the storage of the target holds the encoding.
    TexturePages(std::filesystem::path folder, const Encoding& encoding, const EncodedTarget& target);

    // Compresses the next page, and writes what is complete: its files, or with its last layer those of all.
    // Errors: io, cancelled.
    Status add(const EncodedPage& page, Context& context);

    [[nodiscard]] const std::vector<StoredTexture>& layout() const { return layout_; }

    // Where a texture of a page is.
    struct Place {
        std::string file;
        std::uint32_t layer = 0;
        float scale = 1.0f;
    };
    // Of each texture of the layout.
    [[nodiscard]] const std::vector<Place>& places(std::size_t page) const { return pages_[page]; }

private:
    Status write(std::size_t texture, const std::string& file, const TextureArray& texels) const;
    Result<Place> add_texture(std::size_t texture, const EncodedPage& page, Context& context);

    std::filesystem::path folder_;
    const Encoding* encoding_;
    EncodedTarget target_;
    std::vector<StoredTexture> layout_;
    std::vector<TextureArray> layers_;  // of each texture, those so far
    std::vector<std::vector<Place>> pages_;
};

}  // namespace lumel
