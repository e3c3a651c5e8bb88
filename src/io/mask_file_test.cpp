#include "io/mask_file.h"

#include <gtest/gtest.h>

#include "io/image_io.h"
#include "support/random_masks.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
    std::vector<std::byte> out;
    for (const int v : values) out.push_back(static_cast<std::byte>(v));
    return out;
}

// By hand: one chart of 3 x 2 texels, "###" over "#..".
const std::vector<std::byte> kSmall =
    bytes_of({'C', 'M', 'S', 'K', 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 3, 0, 2, 0, 7, 1});

TEST(MaskFile, ByHand) {
    const auto masks = decode_masks(kSmall, "small.msk");
    ASSERT_TRUE(masks.ok()) << masks.error().text();
    ASSERT_EQ(masks->size(), 1u);
    EXPECT_EQ((*masks)[0].width, 3u);
    EXPECT_EQ((*masks)[0].height, 2u);
    EXPECT_EQ((*masks)[0].used, 4u);
    EXPECT_TRUE((*masks)[0].get(2, 0));
    EXPECT_FALSE((*masks)[0].get(1, 1));
    EXPECT_EQ(encode_masks(*masks), kSmall);
}

TEST(MaskFile, ReadsBackWhatItWrote) {
    const std::vector<ChartMask> masks = test::random_masks(200, 150, 9);
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "level.msk";
    ASSERT_TRUE(write_masks(path, masks).ok());
    const auto read = read_masks(path);
    ASSERT_TRUE(read.ok()) << read.error().text();
    ASSERT_EQ(read->size(), masks.size());
    for (std::size_t i = 0; i < masks.size(); ++i) {
        EXPECT_TRUE(same_texels((*read)[i], masks[i]));
        EXPECT_EQ((*read)[i].used, masks[i].used);
    }
}

// Nothing may be cut off or follow, and each fault has a name.
TEST(MaskFile, RefusesEveryTruncationAndExtraBytes) {
    const std::vector<std::byte> good = encode_masks(test::random_masks(5, 30, 10));
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(decode_masks(std::span(good).first(size), "cut.msk").ok()) << size;
    std::vector<std::byte> more = good;
    more.push_back(std::byte{0});
    EXPECT_FALSE(decode_masks(more, "more.msk").ok());
}

// Each edge by itself could be, and all the bytes are there.
TEST(MaskFile, RefusesChartsThatAreTooLarge) {
    const auto fault = [](std::uint32_t width, std::uint32_t height) {
        const std::vector<ChartMask> masks{test::rectangle_mask(width, height)};
        const auto read = decode_masks(encode_masks(masks), "large.msk");
        if (read.ok()) return std::string("none");
        EXPECT_EQ(read.error().code, ErrorCode::unsupported);
        // Nor is it written.
        const test::TemporaryFolder folder;
        const Status written = write_masks(folder.path() / "large.msk", masks);
        EXPECT_FALSE(written.ok());
        return read.error().text();
    };
    EXPECT_EQ(
        fault(1, 16385),
        "large.msk: chart 0 has 1x16385 texels, more than 16384 along an edge or 67108864 in all (make it smaller, "
        "or several charts)");
    EXPECT_NE(fault(16385, 1), "none");
    EXPECT_NE(fault(8193, 8192), "none");
    EXPECT_EQ(fault(16384, 3), "none");
}

TEST(MaskFile, NamesTheFault) {
    const auto fault = [](std::size_t at, int value) {
        std::vector<std::byte> bytes = kSmall;
        bytes[at] = static_cast<std::byte>(value);
        const auto masks = decode_masks(bytes, "bad.msk");
        return masks.ok() ? std::string("none") : masks.error().text();
    };
    EXPECT_EQ(fault(0, 'X'), "bad.msk: is no file of chart masks (give a .msk file)");
    EXPECT_EQ(fault(4, 2), "bad.msk: is of version 2, not 1 (write it as version 1)");
    EXPECT_EQ(fault(11, 1), "bad.msk: has more than 4000000 charts (make it several files)");
    EXPECT_EQ(fault(8, 9), "bad.msk: ends before the last of 9 charts (write the file again)");
    EXPECT_EQ(fault(16, 0), "bad.msk: chart 0 has no width or no height (write the file again)");
    EXPECT_EQ(fault(19, 1), "bad.msk: ends within chart 0 (write the file again)");
    EXPECT_EQ(fault(20, 15), "bad.msk: chart 0 has texels beyond its width of 3 (write the file again)");
    std::vector<std::byte> empty = kSmall;
    empty[20] = empty[21] = std::byte{0};
    EXPECT_EQ(decode_masks(empty, "bad.msk").error().text(), "bad.msk: chart 0 has no texel (write the file again)");
}

}  // namespace
}  // namespace lumel
