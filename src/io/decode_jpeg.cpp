// JPEG through libjpeg-turbo: the only file that includes it.
#include <turbojpeg.h>

#include <memory>

#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

struct Destroy {
    void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;

const unsigned char* data(std::span<const std::byte> bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

Error undecodable(const Decoder& decoder, const std::string& where) {
    return {ErrorCode::invalid_input, std::string("cannot be decoded: ") + tjGetErrorStr2(decoder.get()), where,
            "the image is damaged or of an unusual kind; save it again as plain PNG or JPEG"};
}

// Printers' colours to RGB in place. Nearly all programs store such files inverted, as Adobe's did first: a code is the
// share of light that its ink lets through.
void cmyk_to_rgb(std::vector<std::uint8_t>& codes) {
    std::size_t out = 0;
    for (std::size_t in = 0; in < codes.size(); in += 4)
        for (std::size_t c = 0; c < 3; ++c)
            codes[out++] = static_cast<std::uint8_t>((codes[in + c] * codes[in + 3] + 127) / 255);
    codes.resize(out);
}

}  // namespace

Result<CodedImage> decode_jpeg(std::span<const std::byte> bytes, std::uint32_t max_edge, const std::string& where) {
    const Decoder decoder(tjInitDecompress());
    if (!decoder) return Error{ErrorCode::io, "no memory for a JPEG decoder", where, "free some memory"};
    const auto size = static_cast<unsigned long>(bytes.size());
    int width = 0, height = 0, subsampling = 0, colour_space = 0;
    if (tjDecompressHeader3(decoder.get(), data(bytes), size, &width, &height, &subsampling, &colour_space) != 0)
        return undecodable(decoder, where);
    LUMEL_TRY_STATUS(check_image_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), 4,
                                      max_edge, bytes.size(), where));
    CodedImage image;
    image.width = static_cast<std::uint32_t>(width);
    image.height = static_cast<std::uint32_t>(height);
    const bool is_grey = colour_space == TJCS_GRAY;
    const bool is_cmyk = colour_space == TJCS_CMYK || colour_space == TJCS_YCCK;
    image.channels = is_grey ? 1 : 3;
    const std::uint32_t stored = is_cmyk ? 4 : image.channels;
    image.codes.resize(std::size_t{image.width} * image.height * stored);
    // Damage is an error, never a picture with grey bars; and a decoder that stops at it cannot be kept busy by a small
    // file of many scans.
    constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
    const int format = is_grey ? TJPF_GRAY : is_cmyk ? TJPF_CMYK : TJPF_RGB;
    if (tjDecompress2(decoder.get(), data(bytes), size, image.codes.data(), width, 0, height, format, kFlags) != 0)
        return undecodable(decoder, where);
    if (is_cmyk) cmyk_to_rgb(image.codes);
    return image;
}

}  // namespace lumel
