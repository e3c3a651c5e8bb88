// Pages of light that is known: what stands in their files, and what scene.glb and the previews show of it.
#include "io/page_writer.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/try.h"
#include "encode/l1.h"
#include "image/tonemap.h"
#include "io/image_io.h"
#include "math/constants.h"
#include "math/frame.h"
#include "support/made_up_page.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::made_up_page;
using test::TemporaryFolder;

float plane_value(const std::filesystem::path& path, const std::string& name, std::size_t pixel) {
    const std::vector<std::string> names{name};
    const auto read = read_exr_channels(path, names);
    EXPECT_TRUE(read.ok()) << read.error().text();
    return read.ok() ? read->planes.at(0).at(pixel) : -1.0f;
}

constexpr LayerWeights kAll{1, 1, 1};

Result<ManifestPage> write(const TemporaryFolder& folder, const Lightmap& map, const LayerWeights& weights) {
    Context context(2);
    WriteProgress progress(context, kPageWork);
    return write_page_files(folder.path(), map, weights, progress);
}

TEST(PageFiles, HoldWhatTheirUnitsSay) {
    const TemporaryFolder folder;
    const Lightmap map = made_up_page(0, 8, 8);
    const auto page = write(folder, map, kAll);
    ASSERT_TRUE(page.ok()) << page.error().text();
    // Pixel 4 is texel 3: I = (0.01 + 0.1 + 1) * 4 * (1, 2, 3).
    const double green = 1.11 * 4 * 2;
    EXPECT_NEAR(plane_value(folder / "lightmap_0.exr", "G", 4), green, 1e-5);
    EXPECT_NEAR(plane_value(folder / "irradiance_0.exr", "G", 4), green * kPi, green * kPi * 0x1p-11);
    EXPECT_EQ(plane_value(folder / "lightmap_0.exr", "G", 5), 0.0f);  // no texel
    EXPECT_NEAR(plane_value(folder / "bent_normal_0.exr", "G", 4), 0.5, 1e-3);
    EXPECT_NEAR(page->coverage, 42.0 / 64, 1e-12);  // 43 texels, one of them dilated
    const auto ao = read_image(folder / "ao_0.png"), sky = read_image(folder / "sky_visibility_0.png");
    ASSERT_TRUE(ao.ok() && sky.ok());
    EXPECT_NEAR(ao->data[0], 128 / 255.0, 1e-6);
    EXPECT_NEAR(sky->data[0], 64 / 255.0, 1e-6);
}

TEST(PageFiles, LayersThatAreNotIncludedAreNotInTheSum) {
    const TemporaryFolder folder;
    Include include;
    include.direct = false;
    ASSERT_TRUE(write(folder, made_up_page(0, 8, 8), layer_weights(include)).ok());
    EXPECT_NEAR(plane_value(folder / "lightmap_0.exr", "R", 0), 1.1, 1e-5);
    // The master keeps all.
    EXPECT_NEAR(plane_value(folder / "master_0.exr", "direct.I.R", 0), 0.01, 1e-7);
}

TEST(PageFiles, TheMasterHoldsEveryMoment) {
    const TemporaryFolder folder;
    const Lightmap map = made_up_page(0, 8, 8);
    ASSERT_TRUE(write(folder, map, kAll).ok());
    const auto all = read_exr_channels(folder / "master_0.exr", {});
    ASSERT_TRUE(all.ok()) << all.error().text();
    std::set<std::string> expected{"coverage", "normal.X",   "normal.Y",   "normal.Z",
                                   "count",    "variance.R", "variance.G", "variance.B"};
    for (const char* layer : kLayerNames)
        for (const char* channel : {"R", "G", "B"}) {
            for (int i = 0; i < 9; ++i) expected.insert(std::string(layer) + ".L" + std::to_string(i) + "." + channel);
            expected.insert(std::string(layer) + ".I." + channel);
        }
    EXPECT_EQ(std::set<std::string>(all->names.begin(), all->names.end()), expected);
    const std::filesystem::path master = folder / "master_0.exr";
    EXPECT_NEAR(plane_value(master, "sky.L0.B", 4), 0.1 * 4 * 3 * 3, 3.6 * 0x1p-11);
    EXPECT_NEAR(plane_value(master, "indirect.L2.R", 4), 0.7 * 4, 2.8 * 0x1p-11);
    EXPECT_EQ(plane_value(master, "count", 4), 63.0f);
    EXPECT_EQ(plane_value(master, "coverage", 4), 3.0f);
    EXPECT_EQ(plane_value(master, "coverage", 5), 0.0f);
    EXPECT_EQ(plane_value(master, "variance.B", 4), 4.0f);
    EXPECT_NEAR(plane_value(master, "normal.Z", 4), -0.8f, 0x1p-11);
}

TEST(PageFiles, L1IsThatOfTheSum) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write(folder, made_up_page(0, 8, 8), kAll).ok());
    RadianceSh<Vec3, 4> sh;
    sh.c[0] = Vec3{1, 2, 3} * (1.11f * 4 * 3.0f);
    sh.c[2] = Vec3{1, 2, 3} * (1.11f * 4 * 0.7f);
    const L1Texel texel = encode_l1(sh);
    const std::filesystem::path file = folder / "l1_0.exr";
    EXPECT_NEAR(plane_value(file, "L0.G", 4), texel.l0.y, texel.l0.y * 0x1p-11);
    EXPECT_NEAR(plane_value(file, "L1n.G.Z", 4), texel.l1n[1].z, 1e-4);
    EXPECT_NEAR(plane_value(file, "L1n.G.X", 4), 0.0, 1e-6);
}

// Sunlight of 120 000 lux on white has E of 120 000, more than a half can hold; starlight less than it resolves.
TEST(PageFiles, NumbersThatHalfCannotHoldAreWrittenAsFloat) {
    for (const float scale : {3000.0f, 1e-6f}) {
        const TemporaryFolder folder;
        Lightmap map = made_up_page(0, 8, 8);
        for (auto& layers : map.texels.layers)
            for (LayerMoments& layer : layers) {
                layer.irradiance *= scale;
                for (Vec3& coefficient : layer.sh) coefficient *= scale;
            }
        const auto page = write(folder, map, kAll);
        ASSERT_TRUE(page.ok());
        const double expected = 1.11 * 43 * 3 * double(scale) * double(kPi);
        const std::size_t last = 8 * 8 - 1;
        EXPECT_NEAR(plane_value(folder / "irradiance_0.exr", "B", last), expected, expected * 1e-6);
        for (const ManifestFile& file : page->files) {
            const bool wide = file.kind == PageFile::irradiance || file.kind == PageFile::master;
            if (wide) {
                EXPECT_EQ(file.type, "float");
            }
        }
    }
}

TEST(PageFiles, ACancelledBakeStopsBetweenRows) {
    const TemporaryFolder folder;
    Context context(1);
    context.request_cancel();
    WriteProgress progress(context, kPageWork);
    const auto page = write_page_files(folder.path(), made_up_page(0, 8, 8), kAll, progress);
    ASSERT_FALSE(page.ok());
    EXPECT_EQ(page.error().code, ErrorCode::cancelled);
    EXPECT_EQ(folder.entries(), 0u);
}

// The bar moves while a page is written, and ends at its end.
TEST(PageFiles, ReportProgressUpToOne) {
    const TemporaryFolder folder;
    Context context(2);
    std::vector<double> fractions;
    context.on_progress = [&](const Progress& progress) {
        EXPECT_EQ(progress.stage, "write");
        fractions.push_back(progress.fraction);
    };
    WriteProgress progress(context, kPageWork);
    ASSERT_TRUE(write_page_files(folder.path(), made_up_page(0, 16, 256), kAll, progress).ok());
    ASSERT_GT(fractions.size(), 20u);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_GT(fractions.front(), 0.0);
    EXPECT_NEAR(fractions.back(), 1.0, 1e-9);
    // No step is larger than the master's 98 channels over its 256 rows, 32 at a time.
    double before = 0.0;
    for (const double fraction : fractions) {
        EXPECT_LE(fraction - before, 98 / kPageWork / 8 + 1e-9);
        before = fraction;
    }
}

// A writer that forgot the unit of its file would go unnoticed as long as that is the unit of the bake itself: here it
// is not, in any file.
TEST(PageFiles, EveryLightGoesThroughTheUnitOfItsFile) {
    const TemporaryFolder folder;
    Context context(1);
    WriteProgress progress(context, kPageWork);
    const Lightmap map = made_up_page(0, 8, 8);
    const auto all_e = [](PageFile) { return LightUnit::e; };
    ASSERT_TRUE(write_page_files(folder.path(), map, kAll, progress, all_e).ok());
    const auto stored = [&](PageFile kind, const char* channel) {
        return double{plane_value(folder / page_file(kind, 0), channel, 4)} / kPi;
    };
    // Texel 3: I = 4.44 * (1, 2, 3); constant coefficient 3 I, of which L0 is the mean over the sphere.
    const double green = 4.44 * 2, half = green * 0x1p-11;
    EXPECT_NEAR(stored(PageFile::lightmap, "G"), green, 1e-5);
    EXPECT_NEAR(stored(PageFile::irradiance, "G"), green, half);
    EXPECT_NEAR(stored(PageFile::l1, "L0.G"), 3 * green * kSh0, 3 * half);
    EXPECT_NEAR(stored(PageFile::master, "indirect.I.G"), 4 * 2, 1e-5);
    EXPECT_NEAR(stored(PageFile::master, "indirect.L0.G"), 3 * 4 * 2, 3 * half);
    EXPECT_NEAR(stored(PageFile::master, "variance.G"), 2 * kPi, 1e-5);
    EXPECT_EQ(unit_of(PageFile::irradiance), LightUnit::e);
    EXPECT_EQ(unit_of(PageFile::lightmap), LightUnit::e_over_pi);
}

TEST(LitTexture, IsAlbedoTimesIrradianceOverItsStrength) {
    const Lightmap map = made_up_page(0, 30, 30);
    const LitTexture texture = lit_texture(map, kAll);
    const auto image = decode_image(texture.png, "texture");
    ASSERT_TRUE(image.ok());
    const std::uint32_t texel = map.texel_at[600];
    const Vec3 expected = Vec3{0.5f, 0.25f, 1.0f} * Vec3{1, 2, 3} * (1.11f * float(texel + 1));
    for (std::size_t c = 0; c < 3; ++c) {
        const float shown = srgb_decode(image->data[600 * image->channels + c]) * texture.strength;
        // Half a step of 8-bit sRGB code, at most 1 % of full scale.
        EXPECT_NEAR(shown, expected[c], 0.01f * texture.strength);
    }
}

TEST(LitTexture, LampsStandOutButDoNotDarkenTheRest) {
    Lightmap map = made_up_page(0, 30, 30);
    const float strength = lit_texture(map, kAll).strength;
    EXPECT_NEAR(strength, 1.11 * 3 * 600, 1e-2);  // the brightest texel's blue
    map.surface.emission[0] = {400000, 200000, 0};
    const LitTexture texture = lit_texture(map, kAll);
    // Twice the 99.9th percentile of 600 texels, which is the one before the last.
    EXPECT_NEAR(texture.strength, 2 * 1.11 * 3 * 599, 1e-2);
    const auto image = decode_image(texture.png, "texture");
    ASSERT_TRUE(image.ok());
    EXPECT_EQ(image->data[0], 1.0f);
    EXPECT_NEAR(srgb_decode(image->data[1]), 0.5f, 0.01f) << "what is cut keeps its colour";
    EXPECT_LT(image->data[2], 0.1f);
    EXPECT_EQ(texture.cut_texels, 0u) << "a lamp's own light is cut without a word";
}

TEST(LitTexture, MakesRoomForPatchesOfSunAndTellsWhatItCuts) {
    Lightmap map = made_up_page(0, 30, 30);
    const auto shine = [&](float times) {
        for (std::size_t c = 0; c < 3; ++c) {
            map.texels.layers[0][0].irradiance[c] = c == 2 ? times * 1.11f * 3 * 599 : 0.0f;
            map.surface.albedo[0] = {1, 1, 1};
        }
        return lit_texture(map, kAll);
    };
    // Of 600 texels the 599th is the measure; beside it now stands the 600th, and the patch is above both.
    const float usual = 1.11f * 3 * 600;
    const LitTexture bright = shine(3.0f);
    EXPECT_NEAR(bright.strength, 3 * 1.11 * 3 * 599, 0.01 * usual);
    EXPECT_EQ(bright.cut_texels, 0u);
    const LitTexture cut = shine(8.0f);
    EXPECT_NEAR(cut.strength, 4 * usual, 0.01 * usual);
    EXPECT_EQ(cut.cut_texels, 1u);
    EXPECT_NEAR(cut.cut_ratio, 2.0f, 0.01f);
}

TEST(LitTexture, ABlackPageHasAUsableStrength) {
    Lightmap map = made_up_page(0, 8, 8);
    for (auto& layers : map.texels.layers) layers = {};
    EXPECT_EQ(lit_texture(map, kAll).strength, 1.0f);
    map.surface.emission[0] = {0, 7, 0};
    EXPECT_EQ(lit_texture(map, kAll).strength, 7.0f);
}

TEST(Preview, IsTheMeanOfCoveredTexels) {
    const Lightmap map = made_up_page(0, 8, 8);
    const PagePreview preview = preview_of(map, kAll, 4);
    EXPECT_EQ(preview.irradiance.width, 4u);
    // Pixels 0, 1 and 9 of the first block (8 is empty): texels 0, 1, 6.
    EXPECT_NEAR(preview.irradiance.data[0], 1.11 * (1 + 2 + 7) / 3, 1e-5);
    EXPECT_NEAR(preview.samples.data[0], 60 + 7.0 / 3, 1e-4);
    EXPECT_EQ(preview.covered[0], 1);
    EXPECT_EQ(preview_of(map, kAll, 8).irradiance.width, 8u);
}

}  // namespace
}  // namespace lumel
