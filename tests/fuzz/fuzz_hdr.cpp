// Any bytes as a Radiance .hdr or a PFM.
#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "io/image_codecs.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    using lumel::fuzz::bytes_of;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    lumel::fuzz::seed_corpus(
        *argc, *argv,
        {bytes_of(header + "-Y 2 +X 1\nabcdefgh"),
         bytes_of(header + "+Y 1 +X 4\nabcd" + std::string("\x01\x01\x01\x03", 4)),
         bytes_of(header + "-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08\x88\x80\x88\x40\x83\x01\x05", 11) +
                  "abcde\x88\x81"),
         bytes_of("PF\n1 1\n-1.0\nabcdefghijkl"), bytes_of("Pf\n1 2\n1.0\nabcdefgh")});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = lumel::fuzz::as_span(data, size);
    const bool pfm = lumel::image_format(bytes) == lumel::ImageFormat::pfm;
    const auto image = pfm ? lumel::decode_pfm(bytes, "fuzz") : lumel::decode_hdr(bytes, "fuzz");
    if (image.ok()) LUMEL_CHECK(image->data.size() == std::size_t{image->width} * image->height * image->channels);
    return 0;
}
