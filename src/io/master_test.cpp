#include "io/master.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "encode/encodings.h"
#include "io/encoded_page.h"
#include "io/image_io.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

constexpr std::uint32_t kWidth = 7, kHeight = 150;  // more rows than are read at once
constexpr Vec3 kNormal{0.6f, 0.0f, -0.8f};

bool is_covered(std::uint32_t x, std::uint32_t y) { return (x + y) % 3 != 0; }
float brightness(std::uint32_t x, std::uint32_t y) { return 1.0f + float(x) + 10.0f * float(y); }

// Uniform light above the surface in two layers, twice as bright in `sky` as in `direct`; `indirect` is never read.
// `spoil` changes a channel's value.
std::filesystem::path write_master(const test::TemporaryFolder& folder,
                                   const std::function<void(const std::string&, float&)>& spoil = {}) {
    std::vector<ExrChannelSource> channels{{"coverage"}, {"normal.X"}, {"normal.Y"}, {"normal.Z"}};
    for (const std::string layer : {"direct.", "sky."})
        for (const std::string k : {"L0", "L1", "L2", "L3", "L4", "L5", "L6", "L7", "L8", "I"})
            for (const char* c : {".R", ".G", ".B"}) channels.push_back({layer + k + c});
    const RadianceSh<float, 9> light = hemisphere_light(1.0f, kNormal);
    const auto value = [&](const std::string& name, std::uint32_t x, std::uint32_t y) {
        if (!is_covered(x, y)) return 0.0f;
        if (name == "coverage") return 3.0f;
        if (name.starts_with("normal.")) return kNormal[static_cast<std::size_t>(name.back() - 'X')];
        const std::size_t dot = name.find('.');
        const float scale = brightness(x, y) * (name.starts_with("sky") ? 2.0f : 1.0f) *
                            (name.back() == 'R' ? 1.0f : (name.back() == 'G' ? 0.5f : 0.0f));
        return name[dot + 1] == 'I' ? scale : scale * light.c[static_cast<std::size_t>(name[dot + 2] - '0')];
    };
    const std::filesystem::path file = folder / "master_0.exr";
    EXPECT_TRUE(write_exr(file, kWidth, kHeight, channels, [&](std::uint32_t y, std::span<float> out) {
                    for (std::size_t c = 0; c < channels.size(); ++c)
                        for (std::uint32_t x = 0; x < kWidth; ++x) {
                            float& v = out[c * kWidth + x];
                            v = value(channels[c].name, x, y);
                            if (spoil && is_covered(x, y)) spoil(channels[c].name, v);
                        }
                    return true;
                }).ok());
    return file;
}

TEST(Master, IsReadBackAndSummed) {
    const test::TemporaryFolder folder;
    const auto file = write_master(folder);
    for (const LayerWeights weights : {LayerWeights{1, 1, 0}, LayerWeights{1, 0, 0}, LayerWeights{0, 1, 0}}) {
        const Result<MasterPage> page = read_master(file, weights);
        ASSERT_TRUE(page.ok()) << page.error().text();
        ASSERT_EQ(page->texel_at.size(), std::size_t{kWidth} * kHeight);
        std::size_t covered = 0;
        for (std::uint32_t y = 0; y < kHeight; ++y)
            for (std::uint32_t x = 0; x < kWidth; ++x) {
                const std::uint32_t t = page->texel_at[std::size_t{y} * kWidth + x];
                ASSERT_EQ(t != kNone, is_covered(x, y));
                if (t == kNone) continue;
                ++covered;
                const float expected = brightness(x, y) * (weights[0] + 2 * weights[1]);
                ASSERT_NEAR(page->irradiance[t].x, expected, 1e-6f * expected) << x << " " << y;
                ASSERT_EQ(page->irradiance[t].z, 0.0f);
                ASSERT_NEAR(page->radiance[t].c[0].y, expected * 0.5f * 1.7724539f, 1e-6f * expected);
                ASSERT_NEAR(dot(page->normal[t], kNormal), 1.0f, 1e-6f);
            }
        EXPECT_EQ(page->size(), covered);
        EXPECT_EQ(page->coverage.size(), covered);
    }
}

void expect_error(const std::function<void(const std::string&, float&)>& spoil, const std::string& text) {
    const test::TemporaryFolder folder;
    const Result<MasterPage> page = read_master(write_master(folder, spoil), {1, 1, 0});
    ASSERT_FALSE(page.ok());
    EXPECT_NE(page.error().text().find(text), std::string::npos) << page.error().text();
}

TEST(Master, DamagedNumbersAreErrors) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    expect_error([](const std::string& n, float& v) { v = n == "sky.L4.B" ? kNan : v; }, "coefficient");
    expect_error([](const std::string& n, float& v) { v = n == "direct.I.G" ? 2e38f * 10 : v; }, "irradiance");
    expect_error([](const std::string& n, float& v) { v = n == "direct.L8.R" ? -1e16f : v; }, "coefficient");
    expect_error([](const std::string& n, float& v) { v = n == "sky.I.B" ? 1e38f : v; }, "irradiance");
    expect_error([](const std::string& n, float& v) { v = n == "normal.X" ? 0.0f : v; }, "unit length");
    expect_error([](const std::string& n, float& v) { v = n == "coverage" ? 0.5f : v; }, "coverage");
}

TEST(Master, OneWithoutNormalsSaysSo) {
    const test::TemporaryFolder folder;
    const Image image(2, 2, 3);
    ASSERT_TRUE(write_exr(folder / "x.exr", image, ExrType::half).ok());
    const Result<MasterPage> page = read_master(folder / "x.exr", {1, 1, 1});
    ASSERT_FALSE(page.ok());
    EXPECT_NE(page.error().text().find("has no channel"), std::string::npos);
}

// Solved, written, read back and decoded: uniform light, whatever frame the numbers are stored in.
TEST(EncodedPage, DecodesToTheLightOfTheMaster) {
    const test::TemporaryFolder folder;
    const Result<MasterPage> master = read_master(write_master(folder), {1, 0, 0});
    ASSERT_TRUE(master.ok());
    Context context(2);
    const Rotation frame = tangent_frame(kNormal);
    const Vec3 n = normalize(Vec3{0.3f, -0.2f, 0.8f});
    for (const Encoding* e : {&kIrradZHhd, &kL1Hhd, &kHlsh, &kL2}) {
        const auto page = encode_page(*e, master.value(), context);
        ASSERT_TRUE(page.ok());
        const std::filesystem::path file = folder / (std::string(e->name) + ".exr");
        ASSERT_TRUE(write_encoded_page(file, *e, page.value(), context).ok());
        std::vector<std::string> names;
        for (const Field& field : e->fields) names.emplace_back(field.name);
        const auto read = read_exr_channels(file, names);
        ASSERT_TRUE(read.ok()) << read.error().text();
        for (std::uint32_t i = 0; i < kWidth * kHeight; i += 11) {
            Numbers numbers{};
            for (std::size_t k = 0; k < names.size(); ++k) numbers[k] = read->planes[k][i];
            if (e->rotate) e->rotate(numbers, frame);
            const std::uint32_t x = i % kWidth, y = i / kWidth;
            const float expected = is_covered(x, y) ? brightness(x, y) * (1 + n.z) / 2 : 0.0f;
            // Halves: 5e-4 of each number, of which L2's are a few times larger than their sum.
            EXPECT_NEAR(e->decode(numbers, n).x, expected, 4e-3f * expected) << e->name << " " << x << " " << y;
        }
    }
}

std::string manifest_of(const std::string& file, int width, int height) {
    return R"({"pages": [{"width": )" + std::to_string(width) + R"(, "height": )" + std::to_string(height) +
           R"(, "files": {"master": {"file": ")" + file + R"("}}}]})";
}

TEST(MasterList, IsThatOfTheManifest) {
    const test::TemporaryFolder folder;
    write_master(folder);
    std::ofstream(folder / "manifest.json") << manifest_of("master_0.exr", kWidth, kHeight);
    Result<MasterList> list = list_masters(folder / "");
    ASSERT_TRUE(list.ok()) << list.error().text();
    ASSERT_EQ(list->pages.size(), 1u);
    EXPECT_TRUE(read_master(list->pages[0], {1, 1, 0}).ok());
    EXPECT_TRUE(check_unchanged(*list).ok());
    ++list->pages[0].width;
    const Result<MasterPage> page = read_master(list->pages[0], {1, 1, 0});
    ASSERT_FALSE(page.ok());
    EXPECT_NE(page.error().text().find("7 x 150 texels"), std::string::npos) << page.error().text();
    std::ofstream(folder / "manifest.json") << manifest_of("master_0.exr", kWidth, kHeight + 1);
    EXPECT_FALSE(check_unchanged(*list).ok());
}

TEST(MasterList, RefusesWhatNoBakeWrites) {
    const auto fails = [](const std::string& manifest) { return !parse_master_list(manifest, "out", "test").ok(); };
    EXPECT_FALSE(fails(manifest_of("master_0.exr", 1, 1)));
    EXPECT_TRUE(fails(manifest_of("../master_0.exr", 1, 1)));
    EXPECT_TRUE(fails(manifest_of("/master_0.exr", 1, 1)));
    EXPECT_TRUE(fails(manifest_of("master_0.exr", 0, 1)));
    EXPECT_TRUE(fails(manifest_of("master_0.exr", 1, 16385)));
    EXPECT_TRUE(fails(R"({"pages": []})"));
    EXPECT_TRUE(fails(R"({"pages": [{"width": 1, "height": 1, "files": {}}]})"));
    EXPECT_TRUE(fails(R"({"pages": [{"width": 1, "height": 1, "files": {"master": 3}}]})"));
}

}  // namespace
}  // namespace lumel
