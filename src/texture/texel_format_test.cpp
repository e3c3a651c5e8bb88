#include "texture/texel_format.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumel {
namespace {

constexpr TexelFormat kAll[] = {
    TexelFormat::rgba16f, TexelFormat::rgb9e5,        TexelFormat::rgba8,       TexelFormat::bc1, TexelFormat::bc4,
    TexelFormat::bc5,     TexelFormat::bc6h_unsigned, TexelFormat::bc6h_signed, TexelFormat::bc7, TexelFormat::rgbm,
    TexelFormat::rgbd,    TexelFormat::logluv,        TexelFormat::rgbe};

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
    for (const TexelFormat format : kAll) {
        const TexelFormatInfo& info = format_info(format);
        SCOPED_TRACE(info.name);
        const Image image = gradient(std::min(info.channels, 3u));
        const auto bytes = encode_texels(format, image, {}, BcQuality::normal, context);
        ASSERT_TRUE(bytes.ok());
        ASSERT_EQ(bytes->size(), texel_bytes(format, image.width, image.height));
        const Image back = decode_texels(format, *bytes, image.width, image.height);
        ASSERT_GE(back.channels, image.channels);
        for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i)
            for (std::uint32_t c = 0; c < image.channels; ++c)
                // BC1 has six bits; LogLuv's chromaticity of eight is the coarsest of the others.
                EXPECT_NEAR(back.data[i * back.channels + c], image.data[i * image.channels + c], 0.04f) << i;
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
    for (const TexelFormat format : kAll) {
        const Image image = gradient(std::min(format_info(format).channels, 3u));
        const auto bytes = encode_texels(format, image, {}, BcQuality::fast, context);
        ASSERT_FALSE(bytes.ok());
        EXPECT_EQ(bytes.error().code, ErrorCode::cancelled);
    }
}

}  // namespace
}  // namespace lumel
