#include "texture/texture_file.h"

#include "base/check.h"

namespace lumel {

void detail::check_texture(const TextureArray& texture) {
    LUMEL_CHECK(format_info(texture.format).vk_format != 0, format_info(texture.format).name);
    LUMEL_CHECK(texture.layers > 0 && !texture.levels.empty(), texture.layers);
    for (std::size_t i = 0; i < texture.levels.size(); ++i)
        LUMEL_CHECK(
            texture.levels[i].size() == texture.layers * texel_bytes(texture.format, level_edge(texture.width, i),
                                                                     level_edge(texture.height, i)),
            i, texture.levels[i].size());
}

}  // namespace lumel
