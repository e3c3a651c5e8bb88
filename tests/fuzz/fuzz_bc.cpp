// Any bytes as blocks of every format: the decoders read nothing beyond them and give numbers.
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "bc/bc1.h"
#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/bc6h.h"
#include "bc/bc7.h"
#include "fuzz/seed_corpus.h"
#include "math/half.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    lumel::fuzz::seed_corpus(*argc, *argv,
                             {lumel::fuzz::bytes_of("\3 two regions..."), lumel::fuzz::bytes_of("@mode six of BC7")});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 16) return 0;
    lumel::BcBlock16 block;
    lumel::BcBlock8 half;
    std::copy_n(data, 16, block.begin());
    std::copy_n(data, 8, half.begin());
    const auto in_range = [](float v) { return v >= 0.0f && v <= 1.0f; };
    for (const bool is_signed : {false, true})
        for (const std::uint16_t code : lumel::decode_bc6h_block(block, is_signed))
            // End points of 16 bits can say -32768, which the format makes minus infinity.
            LUMEL_CHECK(!std::isnan(lumel::half_to_float(code)) && (is_signed || code < 0x7C00), code);
    for (const float v : lumel::decode_bc1_block(half)) LUMEL_CHECK(in_range(v), v);
    for (const float v : lumel::decode_bc4_block(half)) LUMEL_CHECK(in_range(v), v);
    for (const float v : lumel::decode_bc5_block(block)) LUMEL_CHECK(in_range(v), v);
    (void)lumel::decode_bc7_block(block);
    return 0;
}
