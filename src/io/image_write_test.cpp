#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <set>

#include "io/atomic_file.h"
#include "io/image_io.h"
#include "support/statistics.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

Image gradient(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = 0.001f * float(i) - 0.2f;
    return image;
}

void expect_equal(const Image& a, const Image& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.data, b.data);
}

// Runs `f` in a child process whose files may not grow beyond `bytes`: what a full disk looks like to write().
template <class F>
int exit_code_with_small_files(rlim_t bytes, F&& f) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, bytes};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        ::_exit(f() ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(WriteExr, FloatFilesAreLossless) {
    const TemporaryFolder folder;
    const Image image = gradient(37, 21, 3);
    ASSERT_TRUE(write_exr(folder / "a.exr", image, ExrType::full).ok());
    const auto read = read_image(folder / "a.exr");
    ASSERT_TRUE(read.ok()) << read.error().text();
    expect_equal(*read, image);
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteExr, HalfFilesRoundToElevenBitsAndNeverOverflow) {
    const TemporaryFolder folder;
    Image image = gradient(8, 8, 3);
    image.data[0] = 1e6f;
    image.data[1] = -1e6f;
    ASSERT_TRUE(write_exr(folder / "a.exr", image, ExrType::half).ok());
    const auto read = read_image(folder / "a.exr");
    ASSERT_TRUE(read.ok()) << read.error().text();
    EXPECT_EQ(read->data[0], 65504.0f);
    EXPECT_EQ(read->data[1], -65504.0f);
    for (std::size_t i = 2; i < image.data.size(); ++i)
        EXPECT_NEAR(read->data[i], image.data[i], std::fabs(image.data[i]) * 0x1p-11f + 0x1p-25f);
}

// Rows of one channel as 100 y + 10 c + x, rows that end in 7 empty.
bool numbered_row(std::uint32_t y, std::size_t channels, std::span<float> out) {
    if (y % 10 == 7) return false;
    const std::size_t width = out.size() / channels;
    for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t x = 0; x < width; ++x) out[c * width + x] = float(100 * y + 10 * c + x);
    return true;
}

TEST(WriteExr, ChannelsKeepTheirNamesAndRowsTheirPlaces) {
    const TemporaryFolder folder;
    const std::vector<ExrChannelSource> channels{{"direct.L0.R", ExrType::full}, {"coverage", ExrType::half}};
    std::set<std::uint32_t> asked;
    const auto row = [&](std::uint32_t y, std::span<float> out) {
        EXPECT_TRUE(asked.insert(y).second);
        return numbered_row(y, 2, out);
    };
    ASSERT_TRUE(write_exr(folder / "m.exr", 5, 40, channels, row).ok());
    EXPECT_EQ(asked.size(), 40u);
    const std::vector<std::string> names{"coverage", "direct.L0.R"};
    const auto read = read_exr_channels(folder / "m.exr", names);
    ASSERT_TRUE(read.ok()) << read.error().text();
    ASSERT_EQ(read->planes.size(), 2u);
    EXPECT_EQ(read->planes[0][5 * 3 + 2], 312.0f);
    EXPECT_EQ(read->planes[1][5 * 39 + 4], 3904.0f);
    for (std::size_t x = 0; x < 5; ++x) EXPECT_EQ(read->planes[1][5 * 17 + x], 0.0f) << "an empty row";
}

// Chunks are of 16 rows, the last one of 13; how many make a batch differs with the threads.
TEST(WriteExr, AnyNumberOfThreadsWritesTheSameFile) {
    const TemporaryFolder folder;
    const std::vector<ExrChannelSource> channels{{"R", ExrType::full}, {"G", ExrType::half}};
    const auto row = [](std::uint32_t y, std::span<float> out) { return numbered_row(y, 2, out); };
    const auto bytes = [&](Context* context) {
        double last = 0.0;
        const Status status = write_exr(folder / "t.exr", 70, 333, channels, row, context, [&](double fraction) {
            EXPECT_GT(fraction, last);
            last = fraction;
        });
        EXPECT_TRUE(status.ok());
        EXPECT_EQ(last, 1.0);
        return read_file(folder / "t.exr", 1 << 20).value();
    };
    const auto alone = bytes(nullptr);
    for (const unsigned threads : {1u, 2u, 5u}) {
        Context context(threads);
        EXPECT_TRUE(bytes(&context) == alone) << threads << " threads";
    }
}

// Of seven chunks of 16 rows, the last one of four, two hold something: the others are written without being
// compressed.
TEST(WriteExr, EmptyChunksAreZeroInTheirPlaces) {
    const TemporaryFolder folder;
    const std::vector<ExrChannelSource> channels{{"R", ExrType::full}, {"A", ExrType::half}};
    const auto has_light = [](std::uint32_t y) { return y == 36 || y == 64; };
    const auto row = [&](std::uint32_t y, std::span<float> out) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = float(y + i);  // not looked at where the row is empty
        return has_light(y);
    };
    ASSERT_TRUE(write_exr(folder / "e.exr", 6, 100, channels, row).ok());
    const std::vector<std::string> names{"R", "A"};
    const auto read = read_exr_channels(folder / "e.exr", names);
    ASSERT_TRUE(read.ok()) << read.error().text();
    for (std::uint32_t y = 0; y < 100; ++y)
        for (std::uint32_t x = 0; x < 6; ++x)
            for (std::uint32_t c = 0; c < 2; ++c)
                ASSERT_EQ(read->planes[c][6 * y + x], has_light(y) ? float(y + 6 * c + x) : 0.0f) << x << " " << y;
}

// A chunk that compresses to exactly its own size must not be stored compressed, for readers take it as it is. Each
// chunk of 16 rows has a few more random bytes in it than the one before: from well compressed to not at all, so that
// some of the 8,000 come out at that size.
TEST(WriteExr, ChunksThatCompressToTheirOwnSizeAreLossless) {
    const TemporaryFolder folder;
    constexpr std::uint32_t kWidth = 8, kChunks = 1000, kFloats = 16 * kWidth;
    std::mt19937 random(1);
    for (int file = 0; file < 8; ++file) {
        Image image(kWidth, 16 * kChunks, 1);
        for (std::uint32_t chunk = 0; chunk < kChunks; ++chunk)
            for (std::uint32_t i = 0; i < kFloats; ++i) {
                const std::uint32_t noise = i < chunk % kFloats ? random() & 0x007fffffu : 0u;
                image.data[chunk * kFloats + i] = std::bit_cast<float>(0x3f800000u | noise);
            }
        ASSERT_TRUE(write_exr(folder / "a.exr", image, ExrType::full).ok());
        const auto read = read_image(folder / "a.exr");
        ASSERT_TRUE(read.ok()) << read.error().text();
        expect_equal(*read, image);
    }
}

TEST(WriteExr, StopsBetweenRowsWhereCancelled) {
    const TemporaryFolder folder;
    Context context(2);
    const std::vector<ExrChannelSource> channels{{"R", ExrType::full}};
    std::atomic<std::uint32_t> asked{0};
    const auto row = [&](std::uint32_t, std::span<float>) {
        if (++asked == 40) context.request_cancel();
        return false;
    };
    const Status status = write_exr(folder / "c.exr", 8, 4000, channels, row, &context);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::cancelled);
    EXPECT_LT(asked, 100u);
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(WritePng, RoundTripsEightBits) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> pixels(16 * 9 * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = std::uint8_t(i * 7);
    ASSERT_TRUE(write_png(folder / "a.png", 16, 9, 3, pixels).ok());
    const auto read = read_image(folder / "a.png");
    ASSERT_TRUE(read.ok()) << read.error().text();
    ASSERT_GE(read->channels, 3u);
    for (std::size_t i = 0; i < 16 * 9; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(std::lround(read->data[i * read->channels + c] * 255), pixels[3 * i + c]);
}

// Rows that each filter of PNG suits best, between empty ones: specks (none), steps along the row (left), a row again
// and again (above), a noisy level (mean of both), edges of which some stay and one jumps to and fro (Paeth).
TEST(WritePng, RoundTripsWhateverTheRowsAre) {
    const TemporaryFolder folder;
    constexpr std::uint32_t kWidth = 40, kHeight = 70;
    const auto value = [](std::uint32_t x, std::uint32_t y, std::uint32_t noise) -> std::uint32_t {
        switch (y / 10) {
            case 1: return noise < 30 ? 1 : 0;
            case 2: return 6 * x + 37 * y;
            case 3: return x * x / 10 % 7 * 30;
            case 4: return 100 + noise / 16;
            case 5: return x < 20 ? x / 2 % 2 * 90 : (x < (y % 2 ? 24 : 36) ? 30 : 120);
            default: return 0;
        }
    };
    for (const std::uint32_t channels : {1u, 3u, 4u}) {
        test::Random random(channels);
        std::vector<std::uint8_t> pixels(std::size_t{kWidth} * kHeight * channels);
        for (std::uint32_t y = 0; y < kHeight; ++y)
            for (std::uint32_t i = 0; i < kWidth * channels; ++i) {
                const std::uint32_t noise = random.bits() >> 24;
                pixels[std::size_t{y} * kWidth * channels + i] =
                    static_cast<std::uint8_t>(value(i / channels, y, noise));
            }
        ASSERT_TRUE(write_png(folder / "a.png", kWidth, kHeight, channels, pixels).ok());
        const auto read = read_image(folder / "a.png");
        ASSERT_TRUE(read.ok()) << read.error().text();
        ASSERT_EQ(read->width, kWidth);
        ASSERT_GE(read->channels, channels);
        for (std::size_t i = 0; i < std::size_t{kWidth} * kHeight; ++i)
            for (std::size_t c = 0; c < channels; ++c)
                ASSERT_EQ(std::lround(read->data[i * read->channels + c] * 255), pixels[channels * i + c]) << i;
    }
}

TEST(WriteHdr, RoundTripsWithinTheSharedExponent) {
    const TemporaryFolder folder;
    Image image(64, 3, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = std::exp2(float(i % 20) - 10);
    ASSERT_TRUE(write_hdr(folder / "a.hdr", image).ok());
    const auto read = read_image(folder / "a.hdr");
    ASSERT_TRUE(read.ok()) << read.error().text();
    for (std::size_t i = 0; i < image.data.size() / 3; ++i) {
        const float largest = std::max({image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]});
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(read->data[3 * i + c], image.data[3 * i + c], largest / 128);
    }
}

TEST(WritePfm, IsLossless) {
    const TemporaryFolder folder;
    for (const std::uint32_t channels : {1u, 3u}) {
        const Image image = gradient(7, 5, channels);
        ASSERT_TRUE(write_pfm(folder / "a.pfm", image).ok());
        const auto read = read_image(folder / "a.pfm");
        ASSERT_TRUE(read.ok()) << read.error().text();
        expect_equal(*read, image);
    }
}

TEST(AtomicFile, ReplacesAnOlderFileOnlyWhenWhole) {
    const TemporaryFolder folder;
    std::ofstream(folder / "f") << "old";
    {
        AtomicFile abandoned(folder / "f");
        abandoned.write(std::as_bytes(std::span("new", 3)));
    }
    std::string text;
    std::ifstream(folder / "f") >> text;
    EXPECT_EQ(text, "old");
    EXPECT_EQ(folder.entries(), 1u);
    ASSERT_TRUE(write_file(folder / "f", std::as_bytes(std::span("new", 3))).ok());
    std::ifstream(folder / "f") >> text;
    EXPECT_EQ(text, "new");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, AMissingFolderIsAnErrorThatNamesTheFile) {
    const TemporaryFolder folder;
    const Status status = write_file(folder / "no/such/f", {});
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::io);
    EXPECT_NE(status.error().text().find("no/such/f"), std::string::npos);
    EXPECT_NE(status.error().text().find("No such file"), std::string::npos);
    EXPECT_FALSE(status.error().remedy.empty());
}

TEST(AtomicFile, AFolderInThePlaceOfTheFileIsAnError) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "f");
    EXPECT_FALSE(write_file(folder / "f", {}).ok());
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, NoPermissionSaysSo) {
    if (::geteuid() == 0) {
        // Root may write anywhere but in /proc.
        EXPECT_FALSE(write_file("/proc/lumel-test", {}).ok());
        return;
    }
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    const Status status = write_file(folder / "f", {});
    fs::permissions(folder.path(), fs::perms::owner_all);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().text().find("ermission"), std::string::npos);
}

TEST(AtomicFile, AFullDiskLeavesNothingBehind) {
    const TemporaryFolder folder;
    const std::vector<std::byte> bytes(100000);
    const int code = exit_code_with_small_files(50000, [&] {
        const Status status = write_file(folder / "f", bytes);
        return !status.ok() && status.error().code == ErrorCode::io;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(folder.entries(), 0u);
    EXPECT_EQ(exit_code_with_small_files(200000, [&] { return write_file(folder / "f", bytes).ok(); }), 0);
    EXPECT_EQ(folder.entries(), 1u);
}

// OpenEXR's destructor swallows errors: the writer must not.
TEST(WriteExr, AFullDiskIsAnErrorAtAnyByte) {
    const TemporaryFolder folder;
    Image noise(64, 64, 3);
    for (std::size_t i = 0; i < noise.data.size(); ++i) noise.data[i] = std::sin(float(i * i));
    ASSERT_TRUE(write_exr(folder / "whole.exr", noise, ExrType::full).ok());
    const auto size = fs::file_size(folder / "whole.exr");
    for (const rlim_t limit : {rlim_t{0}, rlim_t{10}, rlim_t{500}, rlim_t{size / 2}, rlim_t{size - 1}})
        EXPECT_EQ(
            exit_code_with_small_files(limit, [&] { return !write_exr(folder / "f", noise, ExrType::full).ok(); }), 0)
            << limit;
    EXPECT_EQ(exit_code_with_small_files(size, [&] { return write_exr(folder / "f", noise, ExrType::full).ok(); }), 0);
    EXPECT_EQ(folder.entries(), 2u);
}

}  // namespace
}  // namespace lumel
