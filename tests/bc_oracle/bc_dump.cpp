// Decodes a file of blocks with Lumel's reference decoders, for scripts/oracle/bc_decode.py check:
// lumel_bc_dump FORMAT BLOCKS OUT writes float32 RGBA, 16 texels a block. Channels that a format lacks are 0.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bc/bc1.h"
#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/bc6h.h"
#include "bc/bc7.h"

namespace {

// One block a row, so that a row of four texels of the image is one of the block.
lumel::Image decoded(const std::string& format, const std::vector<std::uint8_t>& blocks) {
    const bool small = format == "bc1" || format == "bc1a" || format == "bc4";
    const auto height = static_cast<std::uint32_t>(4 * (blocks.size() / (small ? 8 : 16)));
    if (format == "bc1" || format == "bc1a") return lumel::decode_bc1(blocks, 4, height);
    if (format == "bc4") return lumel::decode_bc4(blocks, 4, height);
    if (format == "bc5") return lumel::decode_bc5(blocks, 4, height);
    if (format == "bc7") return lumel::decode_bc7(blocks, 4, height);
    return lumel::decode_bc6h(blocks, 4, height, format == "bc6h_sf16");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr, "usage: lumel_bc_dump FORMAT BLOCKS OUT\n");
        return 2;
    }
    std::ifstream in(argv[2], std::ios::binary);
    const std::vector<std::uint8_t> blocks{std::istreambuf_iterator<char>(in), {}};
    const lumel::Image image = decoded(argv[1], blocks);
    std::ofstream out(argv[3], std::ios::binary);
    for (std::size_t i = 0; i < image.data.size(); i += image.channels) {
        std::array<float, 4> texel{};
        std::copy_n(&image.data[i], image.channels, texel.begin());
        out.write(reinterpret_cast<const char*>(texel.data()), sizeof(texel));
    }
    return out.good() ? 0 : 1;
}
