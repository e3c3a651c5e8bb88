// A whole output folder from a made-up lightmap whose numbers are known, so that no ray need be traced.
#include "io/bake_writer.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

#include "base/memory_use.h"
#include "base/try.h"
#include "encode/l1.h"
#include "image/tonemap.h"
#include "io/atomic_file.h"
#include "io/baked.h"
#include "io/image_io.h"
#include "io/light_record.h"
#include "io/manifest.h"
#include "io/output_folder.h"
#include "io/page_writer.h"
#include "math/constants.h"
#include "math/frame.h"
#include "support/json_schema.h"
#include "support/load_gltf.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::JsonSchema;
using test::Loaded;
using test::TemporaryFolder;
using Json = nlohmann::ordered_json;

Json json_file(const std::filesystem::path& path) { return Json::parse(std::ifstream(path)); }

JsonSchema schema(const std::string& name) {
    return JsonSchema(json_file(std::string(LUMEL_SOURCE_DIR) + "/docs/schema/" + name + ".schema.json"));
}

std::string joined(const std::vector<std::string>& lines) {
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

// One texel in three has no value. Layer l of texel t: I = 10^l * (t + 1) * (1, 2, 3) / 100, the constant and one
// linear coefficient.
Lightmap made_up_page(std::uint32_t page, std::uint32_t width, std::uint32_t height) {
    Lightmap map;
    map.page = page;
    map.width = width;
    map.height = height;
    std::uint32_t texels = 0;
    for (std::uint32_t i = 0; i < width * height; ++i) map.texel_at.push_back(i % 3 == 2 ? kNone : texels++);
    map.texels.resize(texels);
    map.coverage.assign(texels, Coverage::baked);
    map.coverage.back() = Coverage::dilated;
    map.surface.albedo.assign(texels, Vec3{0.5f, 0.25f, 1.0f});
    map.surface.emission.assign(texels, Vec3{});
    map.normal.assign(texels, Vec3{0.6f, 0, -0.8f});
    float decade = 0.01f;
    for (std::size_t l = 0; l < kLayerCount; ++l, decade *= 10.0f)
        for (std::uint32_t t = 0; t < texels; ++t) {
            const Vec3 light = Vec3{1, 2, 3} * (decade * float(t + 1));
            LayerMoments& layer = map.texels.layers[t][l];
            layer.irradiance = light;
            layer.sh[0] = light * 3.0f;
            layer.sh[2] = light * 0.7f;
        }
    for (std::uint32_t t = 0; t < texels; ++t) {
        map.texels.count[t] = 60 + t;
        map.texels.ambient_occlusion[t] = 0.5f;
        map.texels.sky_visibility[t] = 0.25f;
        map.texels.bent_normal[t] = {0, 0.5f, 0};
        map.texels.variance[t] = {1, 2, 4};
    }
    return map;
}

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

// Everything but rays: a scene, its layout, made-up pages.
struct Baked {
    explicit Baked(const std::filesystem::path& output, Preset preset = Preset::medium,
                   std::optional<bool> denoise = {}, bool demotes = false, const BakeOptions& light = {},
                   const std::string& sky_hash = {})
        : loaded(scene(demotes)), options(light) {
        loaded.result->sky_hash = sky_hash;
        options.preset = preset;
        options.denoise = denoise;
        ChartOptions chart_options;
        chart_options.texels_per_metre = 12;
        geometry = flatten(loaded.scene(), loaded.context).value();
        charts = make_charts(loaded.scene(), geometry, chart_options, loaded.context).value();
        if (demotes) charts.demoted = {false, true};
        atlas = make_atlas(loaded.scene(), geometry, charts, chart_options, loaded.context).value();
        auto created = BakeWriter::create(output, *loaded.result, options, loaded.context);
        EXPECT_TRUE(created.ok());
        writer.emplace(std::move(created).value());
        EXPECT_TRUE(writer->layout(geometry, charts, atlas).ok());
        for (std::uint32_t p = 0; p < atlas.pages.size(); ++p)
            EXPECT_TRUE(writer->page(made_up_page(p, atlas.pages[p].width, atlas.pages[p].height)).ok());
    }
    // The second node is of class volume by the file, or may become so by its charts.
    static GltfBuilder scene(bool demotes) {
        GltfBuilder builder;
        const std::size_t triangle = builder.triangle();
        builder.node({{"name", "a"}, {"mesh", triangle}});
        Json second{{"name", "b"}, {"mesh", triangle}, {"translation", {2, 0, 0}}};
        if (!demotes) second["extras"]["lightmap"] = false;
        builder.node(second);
        return builder;
    }
    Status finish() {
        BakeReport report;
        report.input_hash = std::string(32, 'a');
        report.stages = {{"trace", 1.5, 2.5}};
        report.pages = {{0, 8, 8, 40, 2, 1, 3, 0.5}};
        report.tracer = "none";
        report.cell_bias = -0.002;  // it has a sign
        report.rays_per_second = std::numeric_limits<double>::infinity();
        loaded.context.diagnostics.add("some-code", "A message.", "somewhere \"quoted\"");
        LUMEL_TRY_STATUS(writer->finish(report, loaded.context.diagnostics));
        return writer->commit();
    }
    Loaded loaded;
    WorldGeometry geometry;
    ChartSet charts;
    Atlas atlas;
    BakeOptions options;
    std::optional<BakeWriter> writer;
};

TEST(BakeWriter, WritesTheWholeFolder) {
    const TemporaryFolder folder;
    Baked baked(folder / "out");
    ASSERT_TRUE(baked.writer->write_scene().ok());
    // Views are rendered from what is there before the folder appears.
    const auto lighting = read_baked(baked.writer->folder(), baked.loaded.scene(), baked.geometry);
    ASSERT_TRUE(lighting.ok()) << lighting.error().text();
    EXPECT_TRUE(lighting->irradiance(0, 0.3f, 0.3f).has_value());
    EXPECT_FALSE(lighting->irradiance(1, 0.3f, 0.3f).has_value());
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    const Status status = baked.finish();
    ASSERT_TRUE(status.ok()) << status.error().text();
    std::set<std::string> expected{"scene.glb", "manifest.json", "report.json"};
    for (const PageFile kind : kPageFiles) expected.insert(page_file(kind, 0));
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) found.insert(entry.path().filename());
    EXPECT_EQ(found, expected);
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(BakeWriter, MipsStandBesideTheirPage) {
    const TemporaryFolder folder;
    Baked baked(folder / "out");
    const AtlasPage page = baked.atlas.pages[0];
    for (std::uint32_t mip = 1; mip <= 2; ++mip) {
        Lightmap map = made_up_page(0, page.width >> mip, page.height >> mip);
        map.mip = mip;
        ASSERT_TRUE(baked.writer->page(map).ok());
    }
    ASSERT_TRUE(baked.writer->write_scene().ok());
    ASSERT_TRUE(baked.finish().ok());
    const Json manifest = json_file(folder / "out/manifest.json");
    EXPECT_EQ(joined(schema("manifest").errors(manifest)), "");
    const Json& mips = manifest["pages"][0]["mips"];
    ASSERT_EQ(mips.size(), 2u);
    EXPECT_EQ(mips[1]["mip"], 2);
    EXPECT_EQ(mips[1]["width"], page.width >> 2);
    EXPECT_EQ(mips[1]["files"]["master"]["file"], "master_0_mip2.exr");
    for (const Json& mip : mips)
        for (const auto& [kind, file] : mip["files"].items()) {
            const std::string name = file["file"];
            EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << kind;
            EXPECT_TRUE(is_output_file(name)) << "goes when the folder is baked anew";
        }
    for (const char* other : {"master_0_mip.exr", "master_mip1.exr", "master_0_mip1.png", "master_a_mip1.exr"})
        EXPECT_FALSE(is_output_file(other)) << other;
}

TEST(BakeWriter, ManifestAndReportFollowTheirSchemas) {
    const TemporaryFolder folder;
    Baked baked(folder / "out");
    ASSERT_TRUE(baked.writer->write_scene().ok());
    ASSERT_TRUE(baked.finish().ok());
    const Json manifest = json_file(folder / "out/manifest.json"), report = json_file(folder / "out/report.json");
    EXPECT_EQ(joined(schema("manifest").errors(manifest)), "");
    EXPECT_EQ(joined(schema("report").errors(report)), "");
    EXPECT_EQ(manifest["denoised"], false);
    EXPECT_EQ(report["options"]["denoise"], false);
    EXPECT_EQ(manifest["instances"][1]["class"], "volume");
    EXPECT_EQ(manifest["instances"][1]["transform"][9], 2.0);
    EXPECT_EQ(manifest["charts"]["page"].size(), baked.atlas.placements.size());
    EXPECT_EQ(report["rays_per_second"], nullptr);
    EXPECT_EQ(report["warnings"].back()["examples"][0], "somewhere \"quoted\"");
    // Every file that the manifest names is there.
    for (const auto& [kind, file] : manifest["pages"][0]["files"].items())
        EXPECT_TRUE(std::filesystem::exists(folder / "out" / file["file"].get<std::string>())) << kind;
}

// What lit the bake is written as the schema says and read back as it was asked for; a sky map is found from elsewhere.
TEST(BakeWriter, TheLightOfTheBakeIsRecorded) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "maps");
    ASSERT_TRUE(write_file(folder / "maps/sky.hdr", std::as_bytes(std::span("made up"))).ok());
    const std::string hash = hash_file(folder / "maps/sky.hdr").value();
    EXPECT_EQ(hash.size(), 32u);
    BakeOptions none, all, constant;
    all.sky.file = folder / "maps/sky.hdr";
    all.sky.intensity = 8000.1;
    all.sky.rotation_degrees = -30;
    all.sky.blur_degrees = 2.5;
    all.sky.extract_sun = true;
    all.sun.direction = unit_or(Vec3{1, -2, 0.3f}, Vec3{});
    all.sun.illuminance = 0.0;
    all.sun.color = {1, 0.9f, 0.8f};
    all.sun.angle_degrees = 0.53;
    all.include.sky = false;
    all.direct_scale = 2;
    all.indirect_scale = 0.5;
    constant.sky.color = Vec3{0.1f, 0.2f, 0.3f};
    for (const BakeOptions& options : {none, all, constant}) {
        Baked baked(folder / "out", Preset::medium, {}, false, options, options.sky.file.empty() ? "" : hash);
        ASSERT_TRUE(baked.writer->write_scene().ok());
        ASSERT_TRUE(baked.finish().ok());
        const Json manifest = json_file(folder / "out/manifest.json"), report = json_file(folder / "out/report.json");
        EXPECT_EQ(joined(schema("manifest").errors(manifest)), "");
        EXPECT_EQ(joined(schema("report").errors(report)), "");
        EXPECT_EQ(report["options"]["sky"], manifest["light"]["sky"]);
        EXPECT_EQ(report["options"]["sun"], manifest["light"]["sun"]);
        const auto read = read_light_record(folder / "out");
        ASSERT_TRUE(read.ok()) << read.error().text();
        EXPECT_EQ(read->input_hash, std::string(32, 'a'));
        EXPECT_EQ(read->sky.color, options.sky.color);
        EXPECT_EQ(read->sky.intensity, options.sky.intensity);
        EXPECT_EQ(read->sky.rotation_degrees, options.sky.rotation_degrees);
        EXPECT_EQ(read->sky.blur_degrees, options.sky.blur_degrees);
        EXPECT_EQ(read->sky.extract_sun, options.sky.extract_sun);
        EXPECT_EQ(read->sun.direction, options.sun.direction);
        EXPECT_EQ(read->sun.illuminance, options.sun.illuminance);
        EXPECT_EQ(read->sun.color, options.sun.color);
        EXPECT_EQ(read->sun.angle_degrees, options.sun.angle_degrees);
        EXPECT_EQ(read->include.sky, options.include.sky);
        EXPECT_EQ(read->direct_scale, options.direct_scale);
        EXPECT_EQ(read->indirect_scale, options.indirect_scale);
        EXPECT_EQ(read->sky.file.empty(), options.sky.file.empty());
        if (options.sky.file.empty()) continue;
        EXPECT_EQ(manifest["light"]["sky"]["file"], "../maps/sky.hdr");
        EXPECT_TRUE(std::filesystem::equivalent(read->sky.file, options.sky.file)) << read->sky.file;
        EXPECT_EQ(read->sky_hash, hash);
    }
}

TEST(LightRecord, WhatIsNoManifestIsAnError) {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& text) {
        EXPECT_TRUE(write_file(folder / "manifest.json", std::as_bytes(std::span(text))).ok());
        const auto read = read_light_record(folder.path());
        return read.ok() ? "" : read.error().text();
    };
    EXPECT_FALSE(read_light_record(folder.path()).ok());
    for (const char* text : {"{}", "[]", "nonsense", R"({"input_hash":"a","layers":{"included":[]}})",
                             R"({"input_hash":"a","layers":{"included":[]},"light":{"sky":{"source":"file"}}})",
                             R"({"input_hash":"a","layers":{"included":[]},"light":{"sun":{"direction":[1]}}})"})
        EXPECT_NE(error(text).find("manifest.json"), std::string::npos) << text;
    EXPECT_EQ(error(R"({"input_hash":"a","layers":{"included":["sky"]},"light":{"sun":null}})"), "");
}

// Nodes that lost their texels to bad charts are written as other volume nodes are.
TEST(BakeWriter, NodesWithBadChartsAreVolume) {
    const TemporaryFolder folder;
    Baked baked(folder / "out", Preset::medium, {}, true);
    ASSERT_EQ(baked.loaded.scene().instances[1].node_class, NodeClass::lightmap);
    ASSERT_TRUE(baked.writer->write_scene().ok());
    const auto lighting = read_baked(baked.writer->folder(), baked.loaded.scene(), baked.geometry);
    ASSERT_TRUE(lighting.ok()) << lighting.error().text();
    EXPECT_TRUE(lighting->irradiance(0, 0.3f, 0.3f).has_value());
    EXPECT_FALSE(lighting->irradiance(1, 0.3f, 0.3f).has_value());
    ASSERT_TRUE(baked.finish().ok());
    const Json manifest = json_file(folder / "out/manifest.json");
    EXPECT_EQ(manifest["instances"][0]["class"], "lightmap");
    EXPECT_EQ(manifest["instances"][1]["class"], "volume");
    EXPECT_EQ(manifest["instances"][1]["charts"][0], manifest["instances"][1]["charts"][1]);
}

TEST(BakeWriter, TheManifestSaysWhetherTheBakeWasDenoised) {
    const auto denoised = [](Preset preset, std::optional<bool> asked) {
        const TemporaryFolder folder;
        Baked baked(folder / "out", preset, asked);
        EXPECT_TRUE(baked.writer->write_scene().ok());
        EXPECT_TRUE(baked.finish().ok());
        return json_file(folder / "out/manifest.json")["denoised"];
    };
    EXPECT_EQ(denoised(Preset::preview, {}), true);
    EXPECT_EQ(denoised(Preset::preview, false), false);
    EXPECT_EQ(denoised(Preset::medium, true), true);
}

TEST(JsonSchema, RefusesWhatTheSchemaForbids) {
    const TemporaryFolder folder;
    Baked baked(folder / "out");
    ASSERT_TRUE(baked.writer->write_scene().ok());
    ASSERT_TRUE(baked.finish().ok());
    const Json manifest = json_file(folder / "out/manifest.json");
    const std::vector<std::pair<const char*, Json>> wrong{{"/version", 2},
                                                          {"/pages/0/width", 1.5},
                                                          {"/pages/0/coverage", 1.1},
                                                          {"/pages/0/files/l1/units", "E "},
                                                          {"/charts/scale/0", {1, 2, 3}},
                                                          {"/instances/0/class", "wall"},
                                                          {"/input_hash", "xyz"},
                                                          {"/unheard_of", 1}};
    for (const auto& [where, value] : wrong) {
        Json broken = manifest;
        broken[Json::json_pointer(where)] = value;
        EXPECT_FALSE(schema("manifest").errors(broken).empty()) << where;
    }
    Json lacking = manifest;
    lacking.erase("units");
    EXPECT_FALSE(schema("manifest").errors(lacking).empty());
}

// The report's peak is that of the process up to the report, not what the caller had measured before the writing: what
// was touched in between is in it.
TEST(BakeWriter, TheReportsPeakIsOfAllThatWasDone) {
    const TemporaryFolder folder;
    Baked baked(folder / "out");
    ASSERT_TRUE(baked.writer->write_scene().ok());
    const std::uint64_t before = peak_memory();
    {
        const std::vector<char> touched(before + (std::size_t{100} << 20), 1);  // more than was let go again
        EXPECT_EQ(touched[touched.size() / 2], 1);
    }
    ASSERT_TRUE(baked.finish().ok());
    const Json report = json_file(folder / "out/report.json");
    EXPECT_GE(report["peak_memory_bytes"].get<std::uint64_t>(), before + (std::uint64_t{100} << 20));
    EXPECT_LE(report["peak_memory_bytes"].get<std::uint64_t>(), peak_memory());
}

// A limit on the size of files stands for the disk: the error names the file where the user will look for it.
TEST(BakeWriterDeathTest, AFullDiskIsToldInTheUsersTerms) {
    const TemporaryFolder folder;
    const auto full = [&] {
        Baked baked(folder / "out");
        rlimit limit{64, 64};
        ::signal(SIGXFSZ, SIG_IGN);
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const Status status = baked.writer->write_scene();
        std::fprintf(stderr, "%s\n", status.ok() ? "no error" : status.error().text().c_str());
        std::_Exit(status.ok() ? 1 : 0);
    };
    EXPECT_EXIT(full(), testing::ExitedWithCode(0), "/out/scene.glb: writing failed");
    Error error{ErrorCode::io, "writing failed: " + std::generic_category().message(ENOSPC), "x", {}};
    EXPECT_TRUE(is_disk_full(error));
    error.message = "writing failed: " + std::generic_category().message(EACCES);
    EXPECT_FALSE(is_disk_full(error));
}

TEST(BakeWriter, AbandonedBakesLeaveNothing) {
    const TemporaryFolder folder;
    {
        Baked baked(folder / "out");
        ASSERT_TRUE(baked.writer->write_scene().ok());
        EXPECT_EQ(folder.entries(), 1u);
    }
    EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace lumel
