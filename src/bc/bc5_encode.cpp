// The encoder of BC5: two of BC4.
#include <algorithm>

#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/block_image.h"

namespace lumel {

Result<std::vector<std::uint8_t>> encode_bc5(const Image& image, std::span<const float> weights,
                                             const Bc5Options& options, Context& context) {
    return encode_blocks<16>(image, weights, context, [&](std::uint32_t x, std::uint32_t y) {
        BlockTexels<2> texels;
        load_block(image, weights, x, y, texels);
        BcBlock16 out;
        for (std::size_t c = 0; c < 2; ++c) {
            const BcBlock8 half = encode_bc4_block(to_codes(texels.value[c]), texels.weight, options.quality);
            std::copy(half.begin(), half.end(), &out[8 * c]);
        }
        return out;
    });
}

}  // namespace lumel
