#include <gtest/gtest.h>

#include <string>

#include "io/image_io.h"

namespace lumel {
namespace {

Result<Image> decode(const std::string& file) { return decode_image(std::as_bytes(std::span(file)), "test.pgm"); }

TEST(DecodePgm, EightAndSixteenBits) {
    const auto grey = decode(std::string("P5\n# a comment\n2 1\n255\n") + '\x00' + '\xff');
    ASSERT_TRUE(grey.ok());
    EXPECT_EQ(grey->channels, 1u);
    EXPECT_EQ(grey->data, (std::vector<float>{0.0f, 1.0f}));
    const auto deep = decode(std::string("P5 1 1 65535 ") + '\x80' + '\x00');
    ASSERT_TRUE(deep.ok());
    EXPECT_FLOAT_EQ(deep->data[0], 32768.0f / 65535.0f);
    const auto color = decode("P6 1 1 100 2Kd");
    ASSERT_TRUE(color.ok());
    EXPECT_EQ(color->data, (std::vector<float>{0.5f, 0.75f, 1.0f}));
}

TEST(DecodePgm, EveryTruncationIsAnError) {
    const std::string whole = std::string("P5\n3 2\n255\n") + "abcdef";
    ASSERT_TRUE(decode(whole).ok());
    for (std::size_t n = 2; n < whole.size(); ++n) EXPECT_FALSE(decode(whole.substr(0, n)).ok()) << n;
}

TEST(DecodePgm, HostileHeadersAreRefused) {
    for (const char* file :
         {"P5 99999999 99999999 255 x", "P5 0 1 255 x", "P5 1 1 0 x", "P5 1 1 70000 xx", "P5 # no end"})
        EXPECT_FALSE(decode(file).ok()) << file;
}

}  // namespace
}  // namespace lumel
