// A page of an encoding as one of its textures stores it, and what is read back.
#pragma once

#include <span>
#include <vector>

#include "encode/encoded_page.h"
#include "texture/layout.h"

namespace lumel {

struct StoredPage {
    std::vector<std::uint8_t> texels;
    float scale = 1.0f;  // E/pi = what is read x scale
};
// A page and its mips.
struct StoredLevels {
    std::vector<std::vector<std::uint8_t>> texels;  // of each level
    float scale = 1.0f;                             // one for all, as shaders filter between levels
};

// Light is scaled by a power of two where the format's range asks for it, for RGBM and RGBD by what the brightest texel
// needs; ratios are stored as 0.5 + 0.5 x. How much a texel's error counts: nothing where no chart lies; for ratios and
// units as much as the light that they shape (its channel where they are of one: L0.R for L1n.R); for light, which
// blocks compare by its logarithm, the same for all. Error: cancelled.
Result<StoredPage> store_page(const Encoding& encoding, const StoredTexture& texture, const EncodedPage& page,
                              BcQuality quality, Context& context);
// The same of a page and its mips, the page first: each with weights of its own, all with one scale.
Result<StoredLevels> store_levels(const Encoding& encoding, const StoredTexture& texture,
                                  std::span<const EncodedPage> levels, BcQuality quality, Context& context);

// The numbers of that texture's fields as shaders get them: into those of the page, which say where texels are.
void read_back(const Encoding& encoding, const StoredTexture& texture, const StoredPage& stored, EncodedPage& page);

// All textures of a layout, there and back: the page as shaders see it. Error: cancelled.
Result<EncodedPage> as_stored(const Encoding& encoding, std::span<const StoredTexture> layout, const EncodedPage& page,
                              BcQuality quality, Context& context);

}  // namespace lumel
