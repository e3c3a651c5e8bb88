// Several texels of a page as one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "post/lightmap.h"

namespace lumel {

// The mean over some texels of a page: of light, moments, normals and surface.
class TexelMean {
public:
    explicit TexelMean(const Lightmap& page) : page_(page) {}

    void add(std::uint32_t texel);
    [[nodiscard]] bool empty() const { return n_ == 0; }
    // The following need some texels. As one texel of another page: the variance is that of a mean of independent
    // texels, coverage the best of theirs, counts are sums.
    void store(Lightmap& to, std::size_t texel, std::uint32_t chart) const;
    // As the light of one beside them, which was not sampled: it varies as they do, and counts are left alone.
    void store_light(RadianceSums& to, std::size_t texel) const;
    void store_surface(Lightmap& to, std::size_t texel) const;

private:
    const Lightmap& page_;
    std::uint32_t n_ = 0;
    std::array<LayerMoments, kLayerCount> layers_{};
    Vec3 variance_{}, difference_{}, bent_{}, albedo_{}, emission_{}, normal_{}, any_normal_{};
    float sky_ = 0.0f, occlusion_ = 0.0f;
    std::uint64_t count_ = 0, open_ = 0;
    Coverage coverage_ = Coverage::none;
};

// All that a page knows of one texel, into one of another page.
void copy_texel(const Lightmap& from, std::size_t texel, Lightmap& to, std::size_t at);

// Of the page, in all arrays that have an entry a texel.
void resize_texels(Lightmap& map, std::size_t texels);

}  // namespace lumel
