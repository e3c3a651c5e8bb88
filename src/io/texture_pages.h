// Pages of an encoding as texture files: KTX2 and DDS, with pages of one size as layers and mips as levels, PNG and
// Radiance HDR, with a file for each.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "encode/encoded_page.h"
#include "io/encoded_target.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "texture/stored_page.h"
#include "texture/texture_file.h"

namespace lumel {

class TexturePages {
public:
    // Precondition: the storage of the target holds the encoding.
    TexturePages(std::filesystem::path folder, const Encoding& encoding, const EncodedTarget& target);

    // Compresses the next page, which is followed by its mips, and writes what is complete: its files, or with its last
    // layer those of all. Precondition: layers of one file have as many mips. Errors: io, cancelled.
    Status add(std::span<const EncodedPage> levels, Context& context);

    [[nodiscard]] const std::vector<StoredTexture>& layout() const { return layout_; }

    // Where a texture of a page is.
    struct Place {
        std::string file;
        std::uint32_t layer = 0, level = 0;  // in the file
        float scale = 1.0f;
    };
    // Of each texture of the layout.
    [[nodiscard]] const std::vector<Place>& places(std::size_t page, std::size_t mip = 0) const {
        return pages_[page][mip];
    }

private:
    Status write(std::size_t texture, const std::string& file, const TextureArray& texels) const;
    Status write_mips(std::size_t texture, std::span<const EncodedPage> levels, StoredLevels stored,
                      std::vector<Place>& places) const;
    // Where each of the levels is.
    Result<std::vector<Place>> add_texture(std::size_t texture, std::span<const EncodedPage> levels, Context& context);

    std::filesystem::path folder_;
    const Encoding* encoding_;
    EncodedTarget target_;
    std::vector<StoredTexture> layout_;
    std::vector<TextureArray> layers_;                    // of each texture, those so far
    std::vector<std::vector<std::vector<Place>>> pages_;  // by page, mip, texture
};

}  // namespace lumel
