#include "texel/texel_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "image/colormap.h"

namespace lumel {
namespace {

template <class ColorOf>
Image paint(const TexelBuffer& texels, ColorOf&& color_of) {
    Image image(texels.width, texels.height, 3);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const Vec3 color = color_of(i);
        std::copy_n(&color.x, 3, image.at(texels.x[i], texels.y[i]));
    }
    return image;
}

float median(std::vector<float> values) {
    if (values.empty()) return 1.0f;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

Image position_picture(const TexelBuffer& texels) {
    if (texels.size() == 0) return {texels.width, texels.height, 3};
    Vec3 low = texels.position[0], high = low;
    for (const Vec3 p : texels.position) {
        low = min(low, p);
        high = max(high, p);
    }
    const float largest = std::max(max_component(high - low), 1e-30f);
    return paint(texels, [&](std::size_t i) { return (texels.position[i] - low) / largest; });
}

Image normal_picture(const TexelBuffer& texels) {
    return paint(texels, [&](std::size_t i) { return texels.normal[i] * 0.5f + Vec3{0.5f, 0.5f, 0.5f}; });
}

Image world_size_picture(const TexelBuffer& texels) {
    const float middle = median(texels.world_size);
    return paint(texels, [&](std::size_t i) {
        const float octaves = std::log2(std::max(texels.world_size[i], 1e-30f) / middle);
        return heat_color(0.5f + octaves / 4.0f);
    });
}

Image triangle_picture(const TexelBuffer& texels) {
    return paint(texels, [&](std::size_t i) { return identity_color(texels.triangles[texels.first_triangle[i]]); });
}

Image validity_picture(const TexelBuffer& texels) {
    return paint(texels, [&](std::size_t i) {
        const float share = static_cast<float>(std::popcount(texels.valid[i])) / static_cast<float>(kSamplesPerTexel);
        return share > 0.0f ? Vec3{share, share, share} : Vec3{1, 0, 0};
    });
}

}  // namespace lumel
