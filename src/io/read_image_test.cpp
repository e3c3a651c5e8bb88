// Images written by hand, by our writer and by other programs; damage to each kind.
#include <gtest/gtest.h>

#include <cstring>

#include "io/image_codecs.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace lumel {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

Result<Image> decode(const std::string& text) { return decode_image(bytes_of(text), "test"); }

std::string error_of(const std::string& text) {
    const auto image = decode(text);
    return image.ok() ? "no error" : image.error().text();
}

std::string hdr(const std::string& size, const std::string& pixels) {
    return "#?RADIANCE\nEXPOSURE=1\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n" + pixels;
}

// Mantissa 128 and exponent 129 are 128 * 2^(129 - 136) = 1.
const std::string kOne{"\x80\x40\x20\x81", 4};

TEST(ReadImage, TellsCodesFromRadiance) {
    const test::TemporaryFolder folder;
    const Image image(2, 2, 3);
    const std::vector<std::uint8_t> pixels(12);
    ASSERT_TRUE(write_exr(folder / "a.png", image, ExrType::half).ok());  // the content decides
    ASSERT_TRUE(write_pfm(folder / "b", image).ok() && write_hdr(folder / "c", image).ok());
    ASSERT_TRUE(write_png(folder / "d", 2, 2, 3, pixels).ok());
    for (const char* name : {"a.png", "b", "c", "d"}) {
        const auto eight_bit = is_eight_bit_image(folder / name);
        ASSERT_TRUE(eight_bit.ok()) << name;
        EXPECT_EQ(*eight_bit, *name == 'd') << name;
    }
    EXPECT_FALSE(is_eight_bit_image(folder / "gone").ok());
}

// 195,759 bytes is what Deflate makes of 8192 x 8192 pixels of one colour.
TEST(CheckImageSize, OnlyDeflateMakesAThousandTimesLess) {
    const auto ok = [](std::uint64_t edge, std::size_t bytes, bool deflated) {
        return check_image_size(edge, edge, 4, kMaxImageEdge, bytes, "a", deflated).ok();
    };
    EXPECT_TRUE(ok(8192, 195759, true));
    EXPECT_FALSE(ok(8192, 195759, false));
    EXPECT_FALSE(ok(8192, 20, true));
    EXPECT_FALSE(ok(16384, 782805, true)) << "4 GB as floats";
}

TEST(DecodeHdr, ReadsFlatPixels) {
    const auto image = decode(hdr("-Y 2 +X 1", kOne + std::string("\x01\x02\x03\x00", 4)));
    ASSERT_TRUE(image.ok()) << image.error().text();
    EXPECT_EQ(image->width, 1u);
    EXPECT_EQ(image->height, 2u);
    EXPECT_EQ(image->at(0, 0)[0], 1.0f);
    EXPECT_EQ(image->at(0, 0)[1], 0.5f);
    EXPECT_EQ(image->at(0, 0)[2], 0.25f);
    EXPECT_EQ(image->at(0, 1)[0], 0.0f) << "exponent 0 is black";
}

TEST(DecodeHdr, ReadsRowsFromTheBottom) {
    const auto image = decode(hdr("+Y 2 +X 1", kOne + std::string(4, '\0')));
    ASSERT_TRUE(image.ok());
    EXPECT_EQ(image->at(0, 1)[0], 1.0f);
    EXPECT_EQ(image->at(0, 0)[0], 0.0f);
}

TEST(DecodeHdr, ReadsRunLengths) {
    // Eight pixels: red as a run, green as a literal, blue as two runs, exponent as a run.
    const std::string row = std::string("\x02\x02\x00\x08", 4) + "\x88\x80" +
                            std::string("\x08\x00\x10\x20\x30\x40\x50\x60\x70", 9) + "\x83\x80\x85\x40" + "\x88\x81";
    const auto image = decode(hdr("-Y 1 +X 8", row));
    ASSERT_TRUE(image.ok()) << image.error().text();
    EXPECT_EQ(image->at(7, 0)[0], 1.0f);
    EXPECT_EQ(image->at(7, 0)[1], float(0x70) / 128);
    EXPECT_EQ(image->at(2, 0)[2], 1.0f);
    EXPECT_EQ(image->at(3, 0)[2], 0.5f);
}

TEST(DecodeHdr, ReadsOldRunLengths) {
    const auto image = decode(hdr("-Y 1 +X 4", kOne + std::string("\x01\x01\x01\x03", 4)));
    ASSERT_TRUE(image.ok()) << image.error().text();
    EXPECT_EQ(image->at(3, 0)[1], 0.5f);
    // Two codes in a row: 3, then 1 shifted by eight bits.
    const auto wide = decode(hdr("-Y 1 +X 260", kOne + std::string("\x01\x01\x01\x03\x01\x01\x01\x01", 8)));
    ASSERT_TRUE(wide.ok()) << wide.error().text();
    EXPECT_EQ(wide->at(259, 0)[1], 0.5f);
}

TEST(DecodeHdr, RefusesDamage) {
    EXPECT_NE(error_of(hdr("-Y 2 +X 1", kOne)).find("ends within the pixels"), std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 1 +X 2", kOne)).find("ends within the pixels"), std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 1 +X 4", kOne + std::string("\x01\x01\x01\x09", 4))).find("leaves its row"),
              std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 1 +X 8", std::string("\x02\x02\x00\x08\x89\x80", 6))).find("leaves its row"),
              std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 1 +X 8", std::string("\x02\x02\x00\x09", 4))).find("another length"), std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 1 +X 8", std::string("\x02\x02\x00\x08\x00\x80", 6))).find("leaves its row"),
              std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 99999 +X 8", "")).find("16384"), std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 16384 +X 16384", "")).find("more than are read"), std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 0 +X 8", "")).find("no pixels"), std::string::npos);
    EXPECT_NE(error_of(hdr("+X 8 -Y 8", "")).find("horizontal"), std::string::npos);
    EXPECT_NE(error_of(hdr("-Y 8 -X 8", "")).find("mirrored"), std::string::npos);
    EXPECT_NE(error_of("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd").find("not RGBE"), std::string::npos);
    EXPECT_NE(error_of("#?RADIANCE\nFORMAT").find("header"), std::string::npos);
}

TEST(DecodePfm, ReadsBothByteOrdersFromTheBottom) {
    const float pixels[2] = {1.5f, -2.0f};
    std::string little(8, '\0'), big(8, '\0');
    std::memcpy(little.data(), pixels, 8);
    for (std::size_t i = 0; i < 8; ++i) big[i] = little[i / 4 * 4 + 3 - i % 4];
    for (const auto& [header, data] : {std::pair{"Pf\n1 2\n-1.0\n", little}, {"Pf\n1 2\n1.0\n", big}}) {
        const auto image = decode(header + data);
        ASSERT_TRUE(image.ok()) << image.error().text();
        EXPECT_EQ(image->channels, 1u);
        EXPECT_EQ(image->at(0, 1)[0], 1.5f) << "the first row of the file is the lowest";
        EXPECT_EQ(image->at(0, 0)[0], -2.0f);
    }
}

TEST(DecodePfm, RefusesDamage) {
    EXPECT_NE(error_of("PF\n2 2\n-1.0\n1234").find("ends within"), std::string::npos);
    EXPECT_NE(error_of("PF\n2 x\n-1.0\n").find("header"), std::string::npos);
    EXPECT_NE(error_of("PF\n2 2").find("header"), std::string::npos);
    EXPECT_NE(error_of("PF\n16000 16000\n-1.0\n").find("more than are read"), std::string::npos);
}

TEST(DecodeImage, NamesWhatItKnows) {
    EXPECT_NE(error_of("GIF89a").find("give PNG, JPEG"), std::string::npos);
    EXPECT_NE(error_of("").find("no image"), std::string::npos);
}

TEST(DecodeImage, PngsAreReadAsStored) {
    const std::vector<std::uint8_t> pixels{0, 51, 255, 102, 153, 204};
    const auto image = decode_image(encode_png(2, 1, 3, pixels), "test");
    ASSERT_TRUE(image.ok()) << image.error().text();
    EXPECT_EQ(image->channels, 3u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(image->data[i], float(pixels[i]) / 255.0f) << "not linearised";
}

// What write_exr wrote, with one function per pixel and channel.
std::vector<std::byte> exr_bytes(test::TemporaryFolder& folder, const std::vector<ExrChannelSource>& channels) {
    const auto path = folder / "image.exr";
    const Status status = write_exr(path, 5, 3, channels, [](std::uint32_t y, std::span<float> out) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = float(i % 5) + 10 * float(y) + 100 * float(i / 5);
        return true;
    });
    EXPECT_TRUE(status.ok());
    return read_file(path, 1 << 20).value();
}

TEST(DecodeExr, FindsColourAndSingleChannels) {
    test::TemporaryFolder folder;
    // Channels stand in the file in alphabetical order; the values say which was asked for.
    const auto rgb = decode_image(exr_bytes(folder, {{"direct.R"}, {"direct.G"}, {"direct.B"}, {"coverage"}}), "test");
    ASSERT_TRUE(rgb.ok()) << rgb.error().text();
    EXPECT_EQ(rgb->channels, 3u);
    EXPECT_EQ(rgb->at(4, 2)[0], 24.0f);
    EXPECT_EQ(rgb->at(4, 2)[1], 124.0f);
    EXPECT_EQ(rgb->at(4, 2)[2], 224.0f);
    const auto one = decode_image(exr_bytes(folder, {{"depth"}}), "test");
    ASSERT_TRUE(one.ok()) << one.error().text();
    EXPECT_EQ(one->channels, 1u);
    EXPECT_EQ(one->at(3, 1)[0], 13.0f);
    const auto neither = decode_image(exr_bytes(folder, {{"a"}, {"b"}}), "test");
    EXPECT_FALSE(neither.ok());
}

TEST(DecodeExr, ReadsNamedChannels) {
    test::TemporaryFolder folder;
    exr_bytes(folder, {{"sky.L0.R"}, {"count"}, {"coverage", ExrType::half}});
    const std::vector<std::string> names{"coverage", "sky.L0.R"};
    const auto channels = read_exr_channels(folder / "image.exr", names);
    ASSERT_TRUE(channels.ok()) << channels.error().text();
    EXPECT_EQ(channels->names, names);
    EXPECT_EQ(channels->planes[0][5], 210.0f);
    EXPECT_EQ(channels->planes[1][5], 10.0f);
    const auto all = read_exr_channels(folder / "image.exr", {});
    ASSERT_TRUE(all.ok());
    EXPECT_EQ(all->names, (std::vector<std::string>{"count", "coverage", "sky.L0.R"}));
    const std::vector<std::string> absent{"direct.R"};
    const auto missing = read_exr_channels(folder / "image.exr", absent);
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().text().find("no channel 'direct.R'"), std::string::npos);
}

TEST(DecodeExr, RefusesEveryTruncation) {
    test::TemporaryFolder folder;
    const std::vector<std::byte> whole = exr_bytes(folder, {{"R"}, {"G"}, {"B"}});
    ASSERT_TRUE(decode_image(whole, "test").ok());
    for (std::size_t size = 0; size < whole.size(); size += 7)
        EXPECT_FALSE(decode_image(std::span(whole).first(size), "test").ok()) << size;
}

// A header attribute that asks for 2 GB, and one whose stated size is not its type's: refused before the library
// believes them.
TEST(DecodeExr, RefusesImpossibleAttributes) {
    test::TemporaryFolder folder;
    const std::vector<std::byte> whole = exr_bytes(folder, {{"R"}, {"G"}, {"B"}});
    const auto size_of = [&](std::vector<std::byte> bytes, const std::string& attribute, std::uint32_t size) {
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::size_t at = text.find(attribute);
        EXPECT_NE(at, std::string::npos);
        std::memcpy(bytes.data() + at + attribute.size(), &size, 4);
        const auto image = decode_image(bytes, "test");
        return image.ok() ? "no error" : image.error().text();
    };
    const std::string window("dataWindow\0box2i\0", 17);
    EXPECT_EQ(size_of(whole, window, 16), "no error");
    EXPECT_NE(size_of(whole, window, 12).find("impossible size"), std::string::npos);
    // 40 bytes more end after the next attribute, displayWindow: a walk that believed the size would miss it.
    EXPECT_NE(size_of(whole, window, 16 + 40).find("impossible size"), std::string::npos);
    EXPECT_NE(size_of(whole, window, 0x70000000).find("impossible size"), std::string::npos);
    EXPECT_NE(size_of(whole, std::string("channels\0chlist\0", 16), 40).find("impossible size"), std::string::npos);
}

TEST(DecodeExr, ReadsPicturesOfOtherPrograms) {
    const auto folder = test::data_file("reference");
    if (!folder) GTEST_SKIP() << "no test data; set LUMEL_DATA";
    int read = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
        if (entry.path().extension() != ".exr") continue;
        const auto image = read_image(entry.path());
        EXPECT_TRUE(image.ok()) << image.error().text();
        ++read;
    }
    EXPECT_GT(read, 0);
}

// A JPEG of 8 x 8 pixels, quantised by ones: `components` with one block each, all of the one symbol that each Huffman
// table has (a difference of zero, then end of block), so that every sample is 128. `adobe` is the transform of the
// Adobe marker, none where negative.
std::string flat_jpeg(std::size_t components, int adobe = -1) {
    std::string jpeg("\xff\xd8", 2);
    if (adobe >= 0)
        jpeg += std::string(
                    "\xff\xee\x00\x0e"
                    "Adobe\x00\x64\x00\x00\x00\x00",
                    15) +
                static_cast<char>(adobe);
    jpeg += std::string("\xff\xdb\x00\x43\x00", 5) + std::string(64, '\x01');
    const auto count = static_cast<char>(components);
    jpeg += std::string("\xff\xc0\x00", 3) + static_cast<char>(8 + 3 * components) +
            std::string("\x08\x00\x08\x00\x08", 5) + count;
    for (std::size_t c = 0; c < components; ++c) jpeg += std::string{static_cast<char>(c + 1), '\x11', '\0'};
    for (const char id : {'\x00', '\x10'})
        jpeg += std::string("\xff\xc4\x00\x14", 4) + id + std::string("\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 17);
    jpeg += std::string("\xff\xda\x00", 3) + static_cast<char>(6 + 2 * components) + count;
    for (std::size_t c = 0; c < components; ++c) jpeg += std::string{static_cast<char>(c + 1), '\0'};
    // Two bits of zero for each block, then ones to the byte's end.
    const unsigned bits = 0xffu >> (2 * components);
    jpeg += std::string("\x00\x3f\x00", 3) + static_cast<char>(bits);
    if (bits == 0xff) jpeg += '\0';
    return jpeg + std::string("\xff\xd9", 2);
}

TEST(DecodeJpeg, ReadsGreyColourAndPrintersColours) {
    const auto grey = decode(flat_jpeg(1));
    ASSERT_TRUE(grey.ok()) << grey.error().text();
    EXPECT_EQ(grey->channels, 1u);
    for (const float value : grey->data) EXPECT_EQ(value, 128.0f / 255.0f);
    const auto colour = decode(flat_jpeg(3));
    ASSERT_TRUE(colour.ok()) << colour.error().text();
    EXPECT_EQ(colour->channels, 3u);
    for (const float value : colour->data) EXPECT_EQ(value, 128.0f / 255.0f);
    // Adobe's inverted CMYK: 128 of 255 passes each ink and again the black.
    const auto print = decode(flat_jpeg(4, 0));
    ASSERT_TRUE(print.ok()) << print.error().text();
    EXPECT_EQ(print->channels, 3u);
    for (const float value : print->data) EXPECT_EQ(value, 64.0f / 255.0f);
}

TEST(DecodeJpeg, RefusesEveryTruncationAndWildTables) {
    const std::string whole = flat_jpeg(3);
    ASSERT_TRUE(decode(whole).ok());
    for (std::size_t size = 3; size + 2 < whole.size(); ++size)
        EXPECT_FALSE(decode(whole.substr(0, size)).ok()) << size;
    // A Huffman table of 320 symbols: there are only 256 bytes.
    std::string wild("\xff\xd8\xff\xc4\x01\x53\x00\x40\x40\x40\x40\x40\0\0\0\0\0\0\0\0\0\0\0", 23);
    wild += std::string(320, '\x01') + whole.substr(2);
    EXPECT_NE(error_of(wild).find("cannot be decoded"), std::string::npos);
}

std::string png_of_ours() {
    const std::vector<std::uint8_t> pixels(2 * 3 * 4, 77);
    std::string png;
    for (const auto byte : encode_png(2, 3, 4, pixels)) png += static_cast<char>(byte);
    return png;
}

TEST(DecodePng, RefusesEveryTruncationAndFlippedByte) {
    const std::string whole = png_of_ours();
    ASSERT_TRUE(decode(whole).ok());
    for (std::size_t i = 8; i < whole.size(); ++i) {
        EXPECT_NE(error_of(whole.substr(0, i)).find("cannot be decoded"), std::string::npos) << i;
        // The checksum of each chunk sees them all; libpng 1.6.48 does not look at that of the end.
        if (i + 4 >= whole.size()) continue;
        std::string flipped = whole;
        flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
        EXPECT_FALSE(decode(flipped).ok()) << i;
    }
    // Another chunk before the header, where the size is looked for, and a header of a million pixels squared.
    std::string crowd = whole;
    const std::string huge("\x00\x0f\x42\x40\x00\x0f\x42\x40", 8);
    crowd.replace(16, 8, huge);
    const auto crc = [](const std::string& bytes) {
        std::uint32_t c = 0xffffffffu;
        for (const char byte : bytes) {
            c ^= static_cast<std::uint8_t>(byte);
            for (int bit = 0; bit < 8; ++bit) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
        }
        c ^= 0xffffffffu;
        return std::string{static_cast<char>(c >> 24), static_cast<char>(c >> 16), static_cast<char>(c >> 8),
                           static_cast<char>(c)};
    };
    crowd.replace(29, 4, crc(crowd.substr(12, 17)));
    const std::string small = "aaAa" + std::string("\0\0\0\1\0\0\0\1", 8);
    crowd.insert(8, std::string("\0\0\0\x08", 4) + small + crc(small));
    // libpng 1.6.39 takes such a file, and its size is ours to refuse; 1.6.48 wants the header first.
    EXPECT_TRUE(error_of(crowd).find("1000000 x 1000000 pixels") != std::string::npos ||
                error_of(crowd).find("cannot be decoded") != std::string::npos)
        << error_of(crowd);
    // Pixel data that state 1 GB.
    std::string large = whole;
    large.replace(whole.find("IDAT") - 4, 4, "\x3f\x52\x47\x42");
    EXPECT_NE(error_of(large).find("ends within the image"), std::string::npos) << error_of(large);
}

// Made with the zlib of another language: what a file may be besides 8-bit RGB(A).
TEST(DecodePng, ReadsPalettesFewBitsAndSixteen) {
    const auto png = [](std::string_view hex) {
        std::string bytes;
        for (std::size_t i = 0; i < hex.size(); i += 2)
            bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
        return bytes;
    };
    // Three of a palette whose second colour is transparent.
    const auto palette =
        decode(png("89504e470d0a1a0a0000000d4948445200000003000000010203000000668efc2700000009504c5445ff000000330000"
                   "0066887ce3b00000000274524e53ff00e5b7304a0000000a4944415478da63900000001a001980008ebb000000004945"
                   "4e44ae426082"));
    ASSERT_TRUE(palette.ok()) << palette.error().text();
    EXPECT_EQ(palette->channels, 4u);
    EXPECT_EQ(palette->data, (std::vector<float>{1, 0, 0, 1, 0, 0.2f, 0, 0, 0, 0, 0.4f, 1}));
    const auto bits =
        decode(png("89504e470d0a1a0a0000000d4948445200000008000000010100000000cb7bd2ee0000000a4944415478da6358080000"
                   "a300a2059d72a10000000049454e44ae426082"));
    ASSERT_TRUE(bits.ok()) << bits.error().text();
    EXPECT_EQ(bits->channels, 1u);
    EXPECT_EQ(bits->data, (std::vector<float>{1, 0, 1, 0, 0, 0, 0, 1}));
    const std::string wide =
        png("89504e470d0a1a0a0000000d4948445200000001000000011002000000c0e78f9d0000000f4944415478da63f8ff9f91"
            "b18101000c03028198c1d1a10000000049454e44ae426082");
    const auto sixteen = decode(wide);
    ASSERT_TRUE(sixteen.ok()) << sixteen.error().text();
    EXPECT_EQ(sixteen->data, (std::vector<float>{1, 257.0f / 65535.0f, 32768.0f / 65535.0f}));
    const auto texture = decode_texture(bytes_of(wide), "test", true);
    ASSERT_TRUE(texture.ok()) << texture.error().text();
    EXPECT_EQ(texture->rgba, (std::vector<std::uint8_t>{255, 1, 128, 255}));
}

TEST(DecodeTexture, MakesRgbaOfEveryKind) {
    const auto texture_of = [](std::uint32_t channels, std::vector<std::uint8_t> pixel) {
        const auto texture = decode_texture(encode_png(1, 1, channels, pixel), "test", true);
        EXPECT_TRUE(texture.ok());
        return texture->rgba;
    };
    using Bytes = std::vector<std::uint8_t>;
    EXPECT_EQ(texture_of(1, {7}), (Bytes{7, 7, 7, 255}));
    EXPECT_EQ(texture_of(2, {7, 9}), (Bytes{7, 7, 7, 9}));
    EXPECT_EQ(texture_of(3, {7, 8, 9}), (Bytes{7, 8, 9, 255}));
    EXPECT_EQ(texture_of(4, {7, 8, 9, 10}), (Bytes{7, 8, 9, 10}));
}

TEST(ReadSky, WantsTwiceAsWideAsHighAndSanePixels) {
    test::TemporaryFolder folder;
    const auto sky_error = [&](std::uint32_t width, std::uint32_t height, float value) {
        Image image(width, height, 3);
        image.data[4] = value;
        EXPECT_TRUE(write_exr(folder / "sky.exr", image, ExrType::full).ok());
        const auto sky = read_sky(folder / "sky.exr");
        return sky.ok() ? "no error" : sky.error().text();
    };
    EXPECT_EQ(sky_error(4, 2, 7.0f), "no error");
    EXPECT_NE(sky_error(4, 3, 1.0f).find("not twice as wide"), std::string::npos);
    EXPECT_NE(sky_error(4, 2, -1.0f).find("pixel (1, 0)"), std::string::npos);
    EXPECT_NE(sky_error(4, 2, std::numeric_limits<float>::infinity()).find("pixel (1, 0)"), std::string::npos);
    EXPECT_FALSE(read_sky(folder / "gone.exr").ok());
}

TEST(ReadSky, ReadsARealMap) {
    const auto path = test::data_file("env/venice_sunset_512.hdr");
    if (!path) GTEST_SKIP() << "no test data; set LUMEL_DATA";
    const auto sky = read_sky(*path);
    ASSERT_TRUE(sky.ok()) << sky.error().text();
    EXPECT_EQ(sky->width, 512u);
    float largest = 0.0f;
    for (const Vec3& pixel : sky->radiance) largest = std::max(largest, max_component(pixel));
    EXPECT_EQ(largest, 1856.0f) << "as the data's table says";
}

TEST(ReadFile, KeepsItsCeiling) {
    test::TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder / "f", bytes_of("12345")).ok());
    EXPECT_EQ(read_file(folder / "f", 5).value(), bytes_of("12345"));
    EXPECT_FALSE(read_file(folder / "f", 4).ok());
    EXPECT_FALSE(read_file(folder.path(), 100).ok()) << "a folder is no file";
    EXPECT_FALSE(read_file("/dev/zero", 100).ok()) << "a device has no end";
}

}  // namespace
}  // namespace lumel
