// Images, samplers and KHR_texture_transform of texture references.
#include "io/gltf_textures.h"

#include <cmath>

#include "base/try.h"
#include "io/image_io.h"
#include "math/trig.h"

namespace lumel {
namespace {

// Extensions that put the image elsewhere, in a format Lumel does not decode.
constexpr const char* kForeignFormats[] = {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif",
                                           "MSFT_texture_dds"};

Result<Wrap> read_wrap(const Json& sampler, const char* key, const std::string& where) {
    LUMEL_TRY(const std::uint64_t code, count_or(sampler, key, 10497, where));
    switch (code) {
        case 10497: return Wrap::repeat;
        case 33071: return Wrap::clamp;
        case 33648: return Wrap::mirror;
        default:
            return invalid(where,
                           std::string("'") + key + "' is " + std::to_string(code) + ", which glTF does not know");
    }
}

}  // namespace

Result<TextureRef> TextureLoader::read(const Json& info, const std::string& user) {
    const std::string where = document_.where + ": " + user;
    LUMEL_TRY(const std::uint64_t index, required_count(info, "index", where));
    LUMEL_TRY(const Json* texture, element(document_.root, "textures", index, where));
    LUMEL_TRY(std::uint64_t uv_set, count_or(info, "texCoord", 0, where));
    TextureRef ref;
    if (const Json* transform = find_extension(info, "KHR_texture_transform")) {
        LUMEL_TRY(uv_set, count_or(*transform, "texCoord", uv_set, where));
        LUMEL_TRY_STATUS(read_transform(*transform, ref, where));
    }
    if (uv_set > 1) return unsupported(where, "uses TEXCOORD_" + std::to_string(uv_set) + "; Lumel reads sets 0 and 1");
    ref.uv_set = static_cast<std::uint8_t>(uv_set);
    LUMEL_TRY_STATUS(read_sampler(*texture, ref, where));
    LUMEL_TRY(const std::uint64_t image, image_of(*texture, where));
    LUMEL_TRY(ref.texture, load(image, user));
    return ref;
}

Result<std::uint64_t> TextureLoader::image_of(const Json& texture, const std::string& where) const {
    LUMEL_TRY(const std::optional<std::uint64_t> source, optional_count(texture, "source", where));
    if (source) return *source;
    for (const char* extension : kForeignFormats)
        if (find_extension(texture, extension))
            return unsupported(where,
                               std::string("its image is only given as ") + extension + ", which Lumel does not decode",
                               "export the texture as PNG or JPEG, or with such a fallback");
    return invalid(where, "its texture has no image");
}

Status TextureLoader::read_sampler(const Json& texture, TextureRef& ref, const std::string& where) const {
    LUMEL_TRY(const std::optional<std::uint64_t> index, optional_count(texture, "sampler", where));
    if (!index) return success();
    LUMEL_TRY(const Json* sampler, element(document_.root, "samplers", *index, where));
    LUMEL_TRY(ref.wrap_u, read_wrap(*sampler, "wrapS", where));
    LUMEL_TRY(ref.wrap_v, read_wrap(*sampler, "wrapT", where));
    LUMEL_TRY(const std::uint64_t filter, count_or(*sampler, "magFilter", 9729, where));
    ref.nearest = filter == 9728;
    return success();
}

// uv' = translation * rotation * scale * uv. UVs turn counter-clockwise as seen in the image, whose v points down; so
// does three.js. (The matrix printed in the extension's text turns the other way; its words and all viewers do not.)
Status TextureLoader::read_transform(const Json& json, TextureRef& ref, const std::string& where) {
    LUMEL_TRY(const auto offset, (numbers_or<2>(json, "offset", {0, 0}, where)));
    LUMEL_TRY(const auto scale, (numbers_or<2>(json, "scale", {1, 1}, where)));
    LUMEL_TRY(const double rotation, number_or(json, "rotation", 0.0, where));
    constexpr double kTurn = 6.283185307179586476925;
    const auto [s, c] = sincos_radians(std::fmod(rotation, kTurn));  // fmod is exact
    const double m[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    for (std::size_t i = 0; i < 6; ++i) ref.transform[i] = static_cast<float>(m[i]);
    return success();
}

Result<std::uint32_t> TextureLoader::load(std::uint64_t image, const std::string& user) {
    if (const auto known = loaded_.find(image); known != loaded_.end()) return known->second;
    auto bytes = document_.image_bytes(image);
    const std::string used_by = ", used as " + user;
    if (!bytes.ok()) {
        Error error = std::move(bytes).error();
        error.where += used_by;
        return error;
    }
    LUMEL_TRY(const Json* json, element(document_.root, "images", image, document_.where));
    const std::string name = label("image", image, *json);
    LUMEL_TRY(Texture texture, decode_texture(*bytes, document_.where + ": " + name + used_by, true));
    const std::uint64_t texels = std::uint64_t{texture.width} * texture.height;
    if (texels > texels_left_)
        return unsupported(document_.where, "its textures grow to far more texels than its file size allows",
                           "the file is damaged, or make the textures smaller");
    texels_left_ -= texels;
    texture.name = name;
    textures_.push_back(std::move(texture));
    const auto index = static_cast<std::uint32_t>(textures_.size() - 1);
    loaded_.emplace(image, index);
    return index;
}

}  // namespace lumel
