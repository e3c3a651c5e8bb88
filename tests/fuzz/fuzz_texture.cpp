// Any bytes as a PNG or JPEG texture. The decoders are libpng's and libjpeg-turbo's; this target watches our use of
// them.
#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "io/image_codecs.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    const std::vector<std::uint8_t> pixels(2 * 3 * 4, 77);
    // A JPEG of 8 x 8 grey pixels, quantised by ones.
    static constexpr unsigned char kHeader[] = {0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
    std::string jpeg(reinterpret_cast<const char*>(kHeader), sizeof kHeader);
    jpeg += std::string(64, '\x01');
    jpeg += std::string("\xff\xc0\x00\x0b\x08\x00\x08\x00\x08\x01\x01\x11\x00", 13);
    for (const char id : {'\x00', '\x10'})
        jpeg += std::string("\xff\xc4\x00\x14", 4) + id + std::string("\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 17);
    jpeg += std::string("\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00\x3f\xff\xd9", 13);
    lumel::fuzz::seed_corpus(*argc, *argv,
                             {lumel::encode_png(2, 3, 4, pixels), lumel::encode_png(4, 3, 2, pixels),
                              lumel::encode_png(8, 3, 1, pixels), lumel::fuzz::bytes_of(jpeg)});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = lumel::fuzz::as_span(data, size);
    const auto texture = lumel::decode_texture(bytes, "fuzz", true);
    if (texture.ok()) LUMEL_CHECK(texture->rgba.size() == std::size_t{texture->width} * texture->height * 4);
    (void)lumel::decode_coded_image(bytes, "fuzz");
    return 0;
}
