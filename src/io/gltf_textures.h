// Texture references of materials: image, sampler, UV set and KHR_texture_transform. Each image is decoded once.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/gltf_document_internal.h"
#include "lumel/scene.h"

namespace lumel {

class TextureLoader {
public:
    TextureLoader(const GltfDocument& document, std::vector<Texture>& textures)
        : document_(document), textures_(textures), texels_left_(kFreeTexels + 64 * document.file_bytes) {}

    // `info` is a textureInfo object; `user` says whose, for messages: "baseColorTexture of material 3 'Wood'".
    Result<TextureRef> read(const Json& info, const std::string& user);

private:
    // A quarter of a gigatexel is free; beyond, the file must be large enough to hold real images.
    static constexpr std::uint64_t kFreeTexels = std::uint64_t{1} << 28;

    Result<std::uint64_t> image_of(const Json& texture, const std::string& user) const;
    Status read_sampler(const Json& texture, TextureRef& ref, const std::string& where) const;
    static Status read_transform(const Json& info, TextureRef& ref, const std::string& where);
    Result<std::uint32_t> load(std::uint64_t image, const std::string& user);

    const GltfDocument& document_;
    std::vector<Texture>& textures_;
    std::map<std::uint64_t, std::uint32_t> loaded_;  // image -> texture
    std::uint64_t texels_left_;
};

}  // namespace lumel
