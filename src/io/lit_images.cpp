#include "io/lit_images.h"

#include <cstring>
#include <string_view>

#include "base/try.h"

namespace lumel {
namespace {

const char* mime_type(std::span<const std::byte> bytes) {
    const auto starts_with = [&](std::string_view magic, std::size_t at = 0) {
        return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
    };
    if (starts_with("\x89PNG")) return "image/png";
    if (starts_with("\xff\xd8\xff")) return "image/jpeg";
    if (starts_with("RIFF") && starts_with("WEBP", 8)) return "image/webp";
    if (starts_with("\xabKTX 20")) return "image/ktx2";
    return nullptr;
}

std::uint32_t append(Json& root, const char* list, Json json) {
    Json& array = root[list];
    if (!array.is_array()) array = Json::array();
    array.push_back(std::move(json));
    return static_cast<std::uint32_t>(array.size() - 1);
}

}  // namespace

Status embed_images(const GltfDocument& document, GlbBuilder& glb) {
    for (std::uint32_t i = 0; i < array_size(glb.root(), "images"); ++i) {
        LUMEL_TRY(const std::vector<std::byte> bytes, document.image_bytes(i));
        if (bytes.empty()) continue;
        Json& image = glb.root()["images"][i];
        image.erase("uri");
        image["bufferView"] = glb.add_view(bytes, ViewTarget::none);
        if (const char* mime = mime_type(bytes)) image["mimeType"] = mime;
    }
    return success();
}

std::vector<PageTexture> add_page_textures(std::span<const LitTexture> pages, GlbBuilder& glb) {
    Json& root = glb.root();
    std::vector<PageTexture> out;
    constexpr unsigned kLinear = 9729, kClamp = 33071;
    const std::uint32_t sampler = append(
        root, "samplers", {{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClamp}, {"wrapT", kClamp}});
    for (std::size_t page = 0; page < pages.size(); ++page) {
        const std::string name = "lightmap " + std::to_string(page) + " times albedo";
        const std::uint32_t view = glb.add_view(pages[page].png, ViewTarget::none);
        const std::uint32_t image =
            append(root, "images", {{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
        const std::uint32_t texture =
            append(root, "textures", {{"name", name}, {"sampler", sampler}, {"source", image}});
        out.push_back({texture, pages[page].strength});
    }
    return out;
}

}  // namespace lumel
