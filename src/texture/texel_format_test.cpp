#include "texture/texel_format.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumel {
namespace {

// What a format may lose of values below 1 that change by 0.27 over a block of 4 x 4.
struct Format {
    TexelFormat format;
    float error;
};
constexpr Format kAll[] = {
    {TexelFormat::rgba16f, 0x1p-12f},  // half a step of 11 bits
    {TexelFormat::rgb9e5, 0x1p-10f},   // half a step of the 9 bits below 1
    {TexelFormat::rgba8, 0.5001f / 255},
    {TexelFormat::bc1, 0.04f},   // 4 colours on a line, ends of 5 and 6 bits
    {TexelFormat::bc4, 0.022f},  // 8 values on a line: half of 0.27 / 7, and ends of 8 bits
    {TexelFormat::bc5, 0.022f},
    // 16 colours on a line in the bits of halves, where three channels that rise together are none: a tenth of the
    // change.
    {TexelFormat::bc6h_unsigned, 0.027f},
    {TexelFormat::bc6h_signed, 0.027f},
    {TexelFormat::bc7, 0.0135f},             // 16 colours on a line: half of 0.27 / 15, and ends of 7 bits
    {TexelFormat::rgbm, 0.002f},             // half a step of 8 bits
    {TexelFormat::rgbd, 2.2f * 0.5f / 255},  // the same, of a power of 2.2
    {TexelFormat::logluv, 0.018f},           // 8 bits of u' and v', whose errors the least of three channels shows most
    {TexelFormat::rgbe, 0x1p-8f},            // a step of the 8 bits below 1
};

// Smooth, 0.2 to 0.9; an odd size, so that edges cut blocks.
Image gradient(std::uint32_t channels) {
    Image out(9, 6, channels);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (std::uint32_t c = 0; c < channels; ++c)
                out.at(x, y)[c] = 0.2f + 0.05f * static_cast<float>(x + c) + 0.04f * static_cast<float>(y);
    return out;
}

TEST(TexelFormats, AllComeBack) {
    Context context(2);
    for (const auto [format, error] : kAll) {
        const TexelFormatInfo& info = format_info(format);
        SCOPED_TRACE(info.name);
        const Image image = gradient(std::min(info.channels, 3u));
        const auto bytes = encode_texels(format, image, {}, BcQuality::normal, context);
        ASSERT_TRUE(bytes.ok());
        ASSERT_EQ(bytes->size(), texel_bytes(format, image.width, image.height));
        const Image back = decode_texels(format, *bytes, image.width, image.height);
        ASSERT_GE(back.channels, image.channels);
        float worst = 0.0f;
        for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i)
            for (std::uint32_t c = 0; c < image.channels; ++c)
                worst =
                    std::max(worst, std::fabs(back.data[i * back.channels + c] - image.data[i * image.channels + c]));
        EXPECT_LE(worst, error);
    }
}

TEST(TexelFormats, PlainTexelsAreExact) {
    Context context(1);
    Image image(2, 1, 3);
    image.data = {1.0f, -2.0f, 0.5f, 70000.0f, NAN, 0.0f};
    const auto half = encode_texels(TexelFormat::rgba16f, image, {}, BcQuality::normal, context);
    ASSERT_TRUE(half.ok());
    EXPECT_EQ(*half, (std::vector<std::uint8_t>{0x00, 0x3C, 0x00, 0xC0, 0x00, 0x38, 0x00, 0x3C,  //
                                                0xFF, 0x7B, 0x00, 0x00, 0x00, 0x00, 0x00, 0x3C}));
    const auto bytes = encode_texels(TexelFormat::rgba8, image, {}, BcQuality::normal, context);
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(*bytes, (std::vector<std::uint8_t>{255, 0, 128, 255, 255, 0, 0, 255}));
}

TEST(TexelFormats, StopWhenCancelled) {
    Context context(1);
    context.request_cancel();
    for (const auto [format, error] : kAll) {
        const Image image = gradient(std::min(format_info(format).channels, 3u));
        const auto bytes = encode_texels(format, image, {}, BcQuality::fast, context);
        ASSERT_FALSE(bytes.ok());
        EXPECT_EQ(bytes.error().code, ErrorCode::cancelled);
    }
}

}  // namespace
}  // namespace lumel
