#include "texture/texel_format.h"

#include <array>
#include <cstring>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "bc/bc1.h"
#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/bc6h.h"
#include "bc/bc7.h"
#include "bc/block_image.h"
#include "encode/light_range.h"
#include "math/half.h"
#include "texture/light_codes.h"

namespace lumel {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Texel = std::array<float, 4>;

struct Coder {
    Result<Bytes> (*encode)(const Image&, std::span<const float>, BcQuality, Context&);
    Image (*decode)(std::span<const std::uint8_t>, std::uint32_t, std::uint32_t);
};

// Formats of single texels -------------------------------------------------------------------------------------------

template <class Code, Code (*kEncode)(Texel)>
Result<Bytes> encode_each(const Image& image, std::span<const float>, BcQuality, Context& context) {
    Bytes out(std::size_t{image.width} * image.height * sizeof(Code));
    const bool done = parallel_for(context, image.height, 16, [&](const ChunkRange& rows) {
        for (std::size_t i = rows.begin * image.width; i < rows.end * image.width; ++i) {
            Texel texel{0, 0, 0, 1};
            std::memcpy(texel.data(), &image.data[i * image.channels], image.channels * sizeof(float));
            const Code code = kEncode(texel);
            std::memcpy(&out[i * sizeof code], &code, sizeof code);
        }
    });
    if (!done) return cancelled_error();
    return out;
}

template <class Code, std::uint32_t kChannels, Texel (*kDecode)(Code)>
Image decode_each(std::span<const std::uint8_t> bytes, std::uint32_t width, std::uint32_t height) {
    Image out(width, height, kChannels);
    for (std::size_t i = 0; i < std::size_t{width} * height; ++i) {
        Code code;
        std::memcpy(&code, &bytes[i * sizeof code], sizeof code);
        const Texel texel = kDecode(code);
        std::memcpy(&out.data[i * kChannels], texel.data(), kChannels * sizeof(float));
    }
    return out;
}

using Halves = std::array<std::uint16_t, 4>;
Halves to_halves(Texel t) { return {half_code(t[0]), half_code(t[1]), half_code(t[2]), half_code(t[3])}; }
Texel of_halves(Halves c) {
    return {half_to_float(c[0]), half_to_float(c[1]), half_to_float(c[2]), half_to_float(c[3])};
}

PixelBytes to_bytes(Texel t) {
    PixelBytes out{};
    for (std::size_t c = 0; c < 4; ++c) {
        const float unit = t[c] > 0.0f ? t[c] : 0.0f;
        out[c] = static_cast<std::uint8_t>((unit < 1.0f ? unit : 1.0f) * 255.0f + 0.5f);
    }
    return out;
}
Texel of_bytes(PixelBytes c) {
    Texel out;
    for (std::size_t i = 0; i < 4; ++i) out[i] = static_cast<float>(c[i]) / 255.0f;
    return out;
}

template <class Code, Code (*kEncode)(Vec3)>
Code encode_light(Texel t) {
    return kEncode({t[0], t[1], t[2]});
}
template <class Code, Vec3 (*kDecode)(Code)>
Texel decode_light(Code code) {
    const Vec3 light = kDecode(code);
    return {light.x, light.y, light.z, 1.0f};
}
template <class Code, Code (*kEncode)(Vec3), Vec3 (*kDecode)(Code)>
constexpr Coder light_coder() {
    return {encode_each<Code, encode_light<Code, kEncode>>, decode_each<Code, 3, decode_light<Code, kDecode>>};
}

// Formats of blocks --------------------------------------------------------------------------------------------------

template <class Options, auto kEncode>
Result<Bytes> encode_of(const Image& image, std::span<const float> weights, BcQuality quality, Context& context) {
    Options options;
    options.quality = quality;
    return kEncode(image, weights, options, context);
}
template <bool kSigned>
Result<Bytes> encode_bc6h_of(const Image& image, std::span<const float> weights, BcQuality quality, Context& context) {
    Bc6hOptions options;
    options.quality = quality;
    options.is_signed = kSigned;
    return encode_bc6h(image, weights, options, context);
}
template <bool kSigned>
Image decode_bc6h_of(std::span<const std::uint8_t> bytes, std::uint32_t width, std::uint32_t height) {
    return decode_bc6h(bytes, width, height, kSigned);
}

// The table ----------------------------------------------------------------------------------------------------------

struct Row {
    TexelFormatInfo info;
    Coder coder;
};
// In the order of TexelFormat. Numbers: VkFormat of Vulkan 1.0, DXGI_FORMAT of Direct3D 11.
constexpr std::array kRows{
    Row{{"R16G16B16A16_SFLOAT", 97, 10, 1, 8, 4, kLargestOfHalves},
        {encode_each<Halves, to_halves>, decode_each<Halves, 4, of_halves>}},
    Row{{"E5B9G9R9_UFLOAT_PACK32", 123, 67, 1, 4, 3, kLargestOfHalves},
        light_coder<std::uint32_t, encode_rgb9e5, decode_rgb9e5>()},
    Row{{"R8G8B8A8_UNORM", 37, 28, 1, 4, 4, 0},
        {encode_each<PixelBytes, to_bytes>, decode_each<PixelBytes, 4, of_bytes>}},
    Row{{"BC1_RGB_UNORM_BLOCK", 131, 71, 4, 8, 3, 0}, {encode_of<Bc1Options, encode_bc1>, decode_bc1}},
    Row{{"BC4_UNORM_BLOCK", 139, 80, 4, 8, 1, 0}, {encode_of<Bc4Options, encode_bc4>, decode_bc4}},
    Row{{"BC5_UNORM_BLOCK", 141, 83, 4, 16, 2, 0}, {encode_of<Bc5Options, encode_bc5>, decode_bc5}},
    Row{{"BC6H_UFLOAT_BLOCK", 143, 95, 4, 16, 3, kLargestOfHalves}, {encode_bc6h_of<false>, decode_bc6h_of<false>}},
    Row{{"BC6H_SFLOAT_BLOCK", 144, 96, 4, 16, 3, kLargestOfHalves}, {encode_bc6h_of<true>, decode_bc6h_of<true>}},
    Row{{"BC7_UNORM_BLOCK", 145, 98, 4, 16, 4, 0}, {encode_of<Bc7Options, encode_bc7>, decode_bc7}},
    Row{{"RGBM", 0, 0, 1, 4, 3, 1.0f}, light_coder<PixelBytes, encode_rgbm, decode_rgbm>()},
    Row{{"RGBD", 0, 0, 1, 4, 3, kLargestRgbd}, light_coder<PixelBytes, encode_rgbd, decode_rgbd>()},
    Row{{"LogLuv", 0, 0, 1, 4, 3, 0}, light_coder<PixelBytes, encode_logluv, decode_logluv>()},
    Row{{"RGBE", 0, 0, 1, 4, 3, 0}, light_coder<PixelBytes, encode_rgbe, decode_rgbe>()},
};
static_assert(kRows.size() == static_cast<std::size_t>(TexelFormat::rgbe) + 1);

const Row& row_of(TexelFormat format) { return kRows[static_cast<std::size_t>(format)]; }

}  // namespace

const TexelFormatInfo& format_info(TexelFormat format) { return row_of(format).info; }

std::size_t texel_bytes(TexelFormat format, std::uint32_t width, std::uint32_t height) {
    const TexelFormatInfo& info = format_info(format);
    const std::size_t across = (std::size_t{width} + info.block_edge - 1) / info.block_edge,
                      down = (std::size_t{height} + info.block_edge - 1) / info.block_edge;
    return across * down * info.block_bytes;
}

Result<std::vector<std::uint8_t>> encode_texels(TexelFormat format, const Image& image, std::span<const float> weights,
                                                BcQuality quality, Context& context) {
    LUMEL_CHECK(image.channels >= 1 && image.channels <= format_info(format).channels, image.channels);
    return row_of(format).coder.encode(image, weights, quality, context);
}

Image decode_texels(TexelFormat format, std::span<const std::uint8_t> bytes, std::uint32_t width,
                    std::uint32_t height) {
    LUMEL_CHECK(bytes.size() == texel_bytes(format, width, height), bytes.size(), width, height);
    return row_of(format).coder.decode(bytes, width, height);
}

}  // namespace lumel
