// A layout that was written is read back as it was, and refused where the charts are others.
#include "io/bake_record.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "io/image_io.h"
#include "io/manifest.h"
#include "support/temporary_folder.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

// The room of the tests, charted and described in a folder, without light.
struct Described {
    test::TemporaryFolder folder;
    Context context{1};
    Scene scene = test::room();
    WorldGeometry geometry = flatten(scene, context).value();
    ChartSet charts;
    Atlas atlas;
    BakeOptions options;

    Described() {
        ChartOptions layout;
        layout.uv1 = Uv1Policy::ignore;
        layout.texels_per_metre = 7.3;  // so that scales are no round numbers
        layout.max_page = 64;
        charts = make_charts(scene, geometry, layout, context).value();
        atlas = make_atlas(scene, geometry, charts, layout, context).value();
        scene.source = (folder / "room.glb").string();
        options.uv1 = Uv1Choice::ignore;
        options.seed = 77;
        options.two_sided = true;
        write();
    }
    void write() const {
        BakeReport report;
        report.input_hash = std::string(32, 'a');
        report.samples_per_texel = 48;
        const std::vector<ManifestPage> pages = [&] {
            std::vector<ManifestPage> out;
            for (const AtlasPage& page : atlas.pages) out.push_back({page.width, page.height, 0.5, {}, 1.0f, {}});
            return out;
        }();
        const ManifestInput input{scene, charts, atlas, options, report, pages, "geometry", "", folder.path()};
        EXPECT_TRUE(write_manifest(input).ok());
        EXPECT_TRUE(write_report(input, {}).ok());
    }
    // Another text in place of the first that is found in a file.
    void replace(const char* file, const std::string& from, const std::string& to) const {
        std::ifstream in(folder / file);
        std::string text((std::istreambuf_iterator<char>(in)), {});
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        ASSERT_TRUE(write_file(folder / file, std::as_bytes(std::span(text))).ok());
    }
    [[nodiscard]] std::string error() const {
        const auto record = read_bake_record(folder.path());
        return record.ok() ? "" : record.error().text();
    }
};

TEST(BakeRecord, TheLayoutIsReadBackBitForBit) {
    const Described described;
    const auto record = read_bake_record(described.folder.path());
    ASSERT_TRUE(record.ok()) << record.error().text();
    const Atlas& layout = record->layout;
    ASSERT_EQ(layout.placements.size(), described.atlas.placements.size());
    ASSERT_EQ(layout.first_placement, described.atlas.first_placement);
    ASSERT_EQ(layout.pages.size(), described.atlas.pages.size());
    for (std::size_t i = 0; i < layout.placements.size(); ++i) {
        const ChartPlacement &read = layout.placements[i], &written = described.atlas.placements[i];
        EXPECT_EQ(read.page, written.page);
        EXPECT_EQ(read.scale.x, written.scale.x);
        EXPECT_EQ(read.scale.y, written.scale.y);
        EXPECT_EQ(read.offset.x, written.offset.x);
        EXPECT_EQ(read.offset.y, written.offset.y);
    }
    EXPECT_EQ(record->options.uv1, Uv1Choice::ignore);
    EXPECT_EQ(record->options.seed, 77u);
    EXPECT_EQ(record->options.samples, 48u);
    EXPECT_TRUE(record->options.two_sided);
    EXPECT_TRUE(std::filesystem::equivalent(record->source.parent_path(), described.folder.path()));
    EXPECT_EQ(record->source.filename(), "room.glb");
    EXPECT_TRUE(check_charts(*record, described.scene, described.charts).ok());
}

TEST(BakeRecord, OtherChartsAreRefused) {
    Described described;
    const auto record = read_bake_record(described.folder.path());
    ASSERT_TRUE(record.ok());
    ChartSet moved = described.charts;
    moved.meshes[0].uv[0][0].x += 0.25f;
    EXPECT_FALSE(check_charts(*record, described.scene, moved).ok());
    ChartSet demoted = described.charts;
    demoted.demoted = {true, false, false, false};
    EXPECT_FALSE(check_charts(*record, described.scene, demoted).ok());
    Scene fewer = described.scene;
    fewer.instances.pop_back();
    EXPECT_FALSE(check_charts(*record, fewer, described.charts).ok());
}

TEST(BakeRecord, WhatIsDamagedIsNamed) {
    const auto after = [](const char* file, const std::string& from, const std::string& to) {
        const Described described;
        described.replace(file, from, to);
        return described.error();
    };
    const auto expect_in = [](const std::string& part, const std::string& text) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    expect_in("report.json", after("report.json", "\"uv1\": \"ignore\"", "\"uv1\": \"perhaps\""));
    expect_in("is of another bake", after("report.json", "aaaa", "bbbb"));
    expect_in("samples_per_texel", after("report.json", "\"samples_per_texel\": 48", "\"samples_per_texel\": 0"));
    expect_in("differ in length", after("manifest.json", "\"scale\":[[", "\"scale\":[[1,1],["));
    expect_in("scale", after("manifest.json", "\"scale\":[[", "\"scale\":[[1,"));
    const Described described;
    described.replace("manifest.json", "source_path", "another_key");
    EXPECT_TRUE(read_bake_record(described.folder.path())->source.empty());  // an older bake
}

}  // namespace
}  // namespace lumel
