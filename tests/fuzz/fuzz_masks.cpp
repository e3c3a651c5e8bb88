// Any bytes as a file of chart masks; small ones are packed, too.
#include <algorithm>
#include <vector>

#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "io/mask_file.h"
#include "pack/pack_pages.h"
#include "support/pack_checker.h"
#include "support/random_masks.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    using lumel::test::random_masks;
    lumel::fuzz::seed_corpus(*argc, *argv,
                             {lumel::encode_masks(random_masks(1, 10, 1)), lumel::encode_masks(random_masks(20, 12, 2)),
                              lumel::encode_masks(random_masks(3, 100, 3))});
    return 0;
}

static void check_packing(const std::vector<lumel::ChartMask>& masks, std::uint32_t width) {
    lumel::Context context(1);
    lumel::PackOptions options;
    options.width = width;
    const lumel::PagePacking packing = lumel::pack_pages(masks, options, context);
    std::vector<lumel::test::PackedSpot> spots;
    for (const lumel::PackedChart& c : packing.charts) spots.push_back({c.page, c.x, c.y, c.orientation});
    const auto drawn = lumel::test::draw_packing(masks, spots, packing.width);
    LUMEL_CHECK(packing.complete && drawn.overlaps == 0 && drawn.outside == 0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = lumel::fuzz::as_span(data, size);
    const auto masks = lumel::decode_masks(bytes, "fuzz");
    if (!masks.ok()) return 0;
    LUMEL_CHECK(std::ranges::equal(lumel::encode_masks(*masks), bytes));
    std::uint32_t widest = 1;
    for (const lumel::ChartMask& mask : *masks) {
        if (mask.width > 512 || mask.height > 512) return 0;
        widest = std::max(widest, mask.width);
    }
    // A page about square, one as narrow as can be, and one of several blocks.
    for (const std::uint32_t width : {0u, widest, 700u}) check_packing(*masks, width);
    return 0;
}
