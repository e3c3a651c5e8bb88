// The texels of a page as pictures for people: R, G, B in [0, 1], to be shown as they are; texels not covered are
// black.
#pragma once

#include "image/image.h"
#include "texel/texel_buffer.h"

namespace lumel {

// World position of the representative point within the bounds of the page: x red, y green, z blue.
Image position_picture(const TexelBuffer& texels);

// Vertex normal n as (n + 1) / 2.
Image normal_picture(const TexelBuffer& texels);

// Metres across a texel on a colour scale of the logarithm: the page's median in the middle, a factor of 16 from end to
// end.
Image world_size_picture(const TexelBuffer& texels);

// A colour per triangle: of the first that a texel has.
Image triangle_picture(const TexelBuffer& texels);

// The share of a texel's sample points that are valid, in grey; red where there is none.
Image validity_picture(const TexelBuffer& texels);

}  // namespace lumel
