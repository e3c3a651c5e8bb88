// Any bytes as a file of chart masks; small ones are packed, too.
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

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = lumel::fuzz::as_span(data, size);
    const auto masks = lumel::decode_masks(bytes, "fuzz");
    if (!masks.ok()) return 0;
    LUMEL_CHECK(lumel::encode_masks(*masks).size() == size);
    for (const lumel::ChartMask& mask : *masks)
        if (mask.width > 512 || mask.height > 512) return 0;
    lumel::Context context(1);
    const lumel::PagePacking packing = lumel::pack_pages(*masks, {}, context);
    std::vector<lumel::test::PackedSpot> spots;
    for (const lumel::PackedChart& c : packing.charts) spots.push_back({c.page, c.x, c.y, c.orientation});
    const auto drawn = lumel::test::draw_packing(*masks, spots, packing.width);
    LUMEL_CHECK(packing.complete && drawn.overlaps == 0 && drawn.outside == 0);
    return 0;
}
