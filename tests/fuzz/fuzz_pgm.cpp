// Any bytes as a PGM or PPM: masks come as these.
#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "image/metrics.h"
#include "io/image_codecs.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    using lumel::fuzz::bytes_of;
    lumel::fuzz::seed_corpus(
        *argc, *argv,
        {bytes_of("P5\n3 2\n255\nabcdef"), bytes_of("P6 1 2 255\nabcdef"),
         bytes_of("P5\n# a mask\n2 1 # wide, high\n65535\nabcd"), bytes_of("P5\n2 2\n1\n\1\1\1\1")});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = lumel::fuzz::as_span(data, size);
    if (lumel::image_format(bytes) != lumel::ImageFormat::pgm) return 0;
    const auto image = lumel::decode_pgm(bytes, "fuzz");
    if (!image.ok()) return 0;
    const std::size_t texels = std::size_t{image->width} * image->height;
    LUMEL_CHECK(image->data.size() == texels * image->channels);
    LUMEL_CHECK(lumel::mask_from_image(*image).size() == texels);
    return 0;
}
