#include "io/texture_pages.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/try.h"
#include "io/image_io.h"

namespace lumel {
namespace {

// Of Zstandard: what a second or two more per page still makes smaller.
int zstd_level(BcQuality quality) {
    switch (quality) {
        case BcQuality::fast: return 3;
        case BcQuality::normal: return 9;
        case BcQuality::best: return 19;
    }
    return 9;
}

// Bytes of RGBA without the alpha that nothing is in: browsers multiply by what they find there.
std::vector<std::uint8_t> without_alpha(const std::vector<std::uint8_t>& rgba) {
    std::vector<std::uint8_t> out;
    out.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) out.insert(out.end(), &rgba[i], &rgba[i] + 3);
    return out;
}

}  // namespace

TexturePages::TexturePages(std::filesystem::path folder, const Encoding& encoding, const EncodedTarget& target)
    : folder_(std::move(folder)), encoding_(&encoding), target_(target) {
    const EncodedFile file = target.format->file;
    LUMEL_CHECK(target.storage != nullptr);
    LUMEL_CHECK(target.layers == 0 || file == EncodedFile::ktx2 || file == EncodedFile::dds, target.format->name);
    layout_ = texture_layout(encoding, *target.storage);
    LUMEL_CHECK(!layout_.empty(), encoding.name);
    layers_.resize(layout_.size());
    for (TextureArray& array : layers_) array.layers = 0;
}

Status TexturePages::write(std::size_t texture, const std::string& file, const TextureArray& texels) const {
    const std::filesystem::path path = folder_ / file;
    switch (target_.format->file) {
        case EncodedFile::ktx2: return write_file(path, encode_ktx2(texels, zstd_level(target_.quality)));
        case EncodedFile::dds: return write_file(path, encode_dds(texels));
        case EncodedFile::exr: break;
        case EncodedFile::hdr:
            if (layout_[texture].format == TexelFormat::rgbe)
                return write_hdr(path, decode_texels(TexelFormat::rgbe, texels.levels[0], texels.width, texels.height));
            [[fallthrough]];
        case EncodedFile::png:
            if (layout_[texture].format == TexelFormat::rgba8)
                return write_png(path, texels.width, texels.height, 3, without_alpha(texels.levels[0]));
            return write_png(path, texels.width, texels.height, 4, texels.levels[0]);
    }
    LUMEL_CHECK(false, target_.format->name);
    return success();
}

// Each in a file of its own.
Status TexturePages::write_mips(std::size_t texture, std::span<const EncodedPage> levels, StoredLevels stored,
                                std::vector<Place>& places) const {
    const auto page = static_cast<std::uint32_t>(pages_.size());
    for (std::uint32_t mip = 0; mip < levels.size(); ++mip) {
        std::string file = encoded_texture_file(*encoding_, layout_[texture], *target_.format, page, mip);
        LUMEL_TRY_STATUS(write(
            texture, file,
            {layout_[texture].format, levels[mip].width, levels[mip].height, 1, {std::move(stored.texels[mip])}}));
        places.push_back({std::move(file), 0, 0, stored.scale});
    }
    return success();
}

Result<std::vector<TexturePages::Place>> TexturePages::add_texture(std::size_t texture,
                                                                   std::span<const EncodedPage> levels,
                                                                   Context& context) {
    const EncodedPage& page = levels[0];
    const StoredTexture& layout = layout_[texture];
    LUMEL_TRY(StoredLevels stored, store_levels(*encoding_, layout, levels, target_.quality, context));
    std::vector<Place> places;
    if (target_.format->file != EncodedFile::ktx2 && target_.format->file != EncodedFile::dds) {
        LUMEL_TRY_STATUS(write_mips(texture, levels, std::move(stored), places));
        return places;
    }
    Place place{{}, 0, 0, stored.scale};
    TextureArray& array = layers_[texture];
    if (array.layers == 0)
        array = {layout.format, page.width, page.height, 0, std::vector<std::vector<std::uint8_t>>(levels.size())};
    LUMEL_CHECK(page.width == array.width && page.height == array.height, page.width, page.height);
    LUMEL_CHECK(levels.size() == array.levels.size(), levels.size(), array.levels.size());
    place.file = target_.layers == 0 ? encoded_texture_file(*encoding_, layout, *target_.format,
                                                            static_cast<std::uint32_t>(pages_.size()))
                                     : encoded_texture_file(*encoding_, layout, *target_.format);
    place.layer = array.layers++;
    for (; place.level < levels.size(); ++place.level) {
        const std::vector<std::uint8_t>& texels = stored.texels[place.level];
        array.levels[place.level].insert(array.levels[place.level].end(), texels.begin(), texels.end());
        places.push_back(place);
    }
    if (array.layers == std::max(target_.layers, 1u)) {
        LUMEL_TRY_STATUS(write(texture, place.file, array));
        array.layers = 0;
        array.levels.clear();
    }
    return places;
}

Status TexturePages::add(std::span<const EncodedPage> levels, Context& context) {
    std::vector<std::vector<Place>> places(levels.size());
    for (std::size_t t = 0; t < layout_.size(); ++t) {
        LUMEL_TRY(std::vector<Place> of_texture, add_texture(t, levels, context));
        for (std::size_t mip = 0; mip < levels.size(); ++mip) places[mip].push_back(std::move(of_texture[mip]));
    }
    pages_.push_back(std::move(places));
    return success();
}

}  // namespace lumel
