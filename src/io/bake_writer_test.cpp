// A whole output folder from a made-up lightmap whose numbers are known, so that no ray need be traced.
#include "io/bake_writer.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>

#include "base/memory_use.h"
#include "base/try.h"
#include "io/atomic_file.h"
#include "io/baked.h"
#include "io/image_io.h"
#include "io/light_record.h"
#include "io/manifest.h"
#include "io/output_folder.h"
#include "io/page_writer.h"
#include "math/frame.h"
#include "support/json_schema.h"
#include "support/load_gltf.h"
#include "support/made_up_page.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::JsonSchema;
using test::Loaded;
using test::made_up_page;
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
