#include "io/texture_pages.h"

#include <array>

#include "base/check.h"
#include "base/try.h"
#include "io/image_io.h"
#include "texture/stored_page.h"

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

Result<TexturePages::Place> TexturePages::add_texture(std::size_t texture, const EncodedPage& page, Context& context) {
    LUMEL_TRY(StoredPage stored, store_page(*encoding_, layout_[texture], page, target_.quality, context));
    Place place{{}, 0, stored.scale};
    if (target_.layers == 0) {
        const auto number = static_cast<std::uint32_t>(pages_.size());
        place.file = encoded_texture_file(*encoding_, layout_[texture], *target_.format, number);
        LUMEL_TRY_STATUS(write(texture, place.file,
                               {layout_[texture].format, page.width, page.height, 1, {std::move(stored.texels)}}));
        return place;
    }
    TextureArray& array = layers_[texture];
    if (pages_.empty()) array = {layout_[texture].format, page.width, page.height, 0, {{}}};
    LUMEL_CHECK(page.width == array.width && page.height == array.height, page.width, page.height);
    place.file = encoded_texture_file(*encoding_, layout_[texture], *target_.format);
    place.layer = array.layers++;
    array.levels[0].insert(array.levels[0].end(), stored.texels.begin(), stored.texels.end());
    if (array.layers == target_.layers) {
        LUMEL_TRY_STATUS(write(texture, place.file, array));
        array = {};
    }
    return place;
}

Status TexturePages::add(const EncodedPage& page, Context& context) {
    std::vector<Place> places;
    for (std::size_t t = 0; t < layout_.size(); ++t) {
        LUMEL_TRY(Place place, add_texture(t, page, context));
        places.push_back(std::move(place));
    }
    pages_.push_back(std::move(places));
    return success();
}

}  // namespace lumel
