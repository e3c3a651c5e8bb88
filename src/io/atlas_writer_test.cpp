// The folder of lumel atlas: what is in it, when it appears, and that it can be read back as a layout to keep.
#include "io/atlas_writer.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "io/atlas_record_read.h"
#include "io/image_io.h"
#include "support/json_schema.h"
#include "support/load_gltf.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Names = std::set<std::string>;

Json json_file(const fs::path& path) { return Json::parse(std::ifstream(path)); }

Names names_in(const fs::path& folder) {
    Names out;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) out.insert(entry.path().filename());
    return out;
}

const Names kOnePage{"atlas.json", "atlas_charts_0.png", "atlas_density_0.png", "atlas_stretch_0.png",
                     "atlas_waste_0.png"};

// Two triangles, laid out.
struct LaidOut {
    explicit LaidOut(double texels_per_metre = 16, const MaskRule& masks = {}) : loaded(scene()) {
        ChartOptions options;
        options.masks = masks;
        options.texels_per_metre = texels_per_metre;
        geometry = flatten(loaded.scene(), loaded.context).value();
        charts = make_charts(loaded.scene(), geometry, options, loaded.context).value();
        atlas = make_atlas(loaded.scene(), geometry, charts, options, loaded.context).value();
    }
    static test::GltfBuilder scene() {
        test::GltfBuilder builder;
        const std::size_t triangle = builder.triangle();
        builder.node({{"name", "left"}, {"mesh", triangle}});
        builder.node({{"name", "right"}, {"mesh", triangle}, {"translation", {2, 0, 0}}});
        return builder;
    }
    Result<AtlasStatistics> write(AtlasWriter& writer) {
        return writer.write(loaded.scene(), geometry, charts, atlas, loaded.context);
    }

    test::Loaded loaded;
    WorldGeometry geometry;
    ChartSet charts;
    Atlas atlas;
};

class AtlasFolder : public testing::Test {
protected:
    AtlasStatistics write_all(LaidOut& laid_out) {
        auto writer = AtlasWriter::create(out);
        if (!writer.ok()) {
            ADD_FAILURE() << writer.error().text();
            return {};
        }
        const Result<AtlasStatistics> statistics = laid_out.write(*writer);
        EXPECT_TRUE(statistics.ok());
        EXPECT_TRUE(writer->commit().ok());
        return statistics.ok() ? *statistics : AtlasStatistics{};
    }
    const test::TemporaryFolder folder;
    const fs::path out = folder / "deep/out";
    LaidOut laid_out;
};

TEST_F(AtlasFolder, HoldsWhatTheSchemaSays) {
    const AtlasStatistics statistics = write_all(laid_out);
    EXPECT_EQ(names_in(out), kOnePage);
    const Json json = json_file(out / "atlas.json");
    const test::JsonSchema schema(json_file(std::string(LUMEL_SOURCE_DIR) + "/docs/schema/atlas.schema.json"));
    for (const std::string& line : schema.errors(json)) ADD_FAILURE() << line;
    ASSERT_EQ(json["pages"].size(), 1u);
    for (const auto& [kind, file] : json["pages"][0]["files"].items())
        EXPECT_TRUE(fs::exists(out / file.get<std::string>())) << kind;
    EXPECT_EQ(json["statistics"]["charts"], 2);
    EXPECT_EQ(statistics.charts, 2u);
    EXPECT_EQ(json["statistics"]["used"], json["pages"][0]["used"]);
    EXPECT_GT(statistics.used, statistics.covered);
    EXPECT_GT(statistics.covered, 0u);
    EXPECT_NEAR(statistics.stretch, 1.0, 1e-6);
    EXPECT_NEAR(statistics.mean_density, 16.0, 0.8);  // boxes of some ten texels are fitted to whole ones
    EXPECT_EQ(json["instances"][1]["charts"], Json({1, 2}));
    const AtlasPage page = laid_out.atlas.pages[0];
    const auto picture = read_image(out / "atlas_waste_0.png");
    ASSERT_TRUE(picture.ok());
    EXPECT_EQ(picture->width, page.width);
    EXPECT_EQ(picture->height, page.height);
    // What is free is red; there are as many such pixels as the figures say.
    std::uint64_t red = 0;
    for (std::size_t i = 0; i < picture->data.size(); i += picture->channels)
        red += picture->data[i] > 0.8f && picture->data[i + 1] < 0.2f ? 1 : 0;
    EXPECT_EQ(red, std::uint64_t{page.width} * page.height - statistics.used);
}

TEST_F(AtlasFolder, IsReadBackAsALayoutToKeep) {
    write_all(laid_out);
    const auto record = read_atlas_record(out / "atlas.json");
    ASSERT_TRUE(record.ok()) << record.error().text();
    EXPECT_EQ((*record)->density, 16.0);
    ASSERT_EQ((*record)->charts.size(), 2u);
    const std::vector<ChartName> names = chart_names(laid_out.loaded.scene(), laid_out.charts);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ((*record)->charts[i].name.id, names[i].id);
        EXPECT_EQ((*record)->charts[i].name.place, names[i].place) << "transforms survive being written";
        EXPECT_EQ((*record)->charts[i].box, laid_out.atlas.placements[i].box);
    }
    EXPECT_NE(names[0].id, names[1].id) << "the nodes have names of their own";
}

// What a layout for mips wastes is said mip by mip, and the layout is known again as one for them.
TEST_F(AtlasFolder, SaysWhatEachMipUses) {
    const MaskRule rule{LookupFilter::bilinear, 2, 1};
    LaidOut for_mips(16, rule);
    const AtlasStatistics statistics = write_all(for_mips);
    const Json json = json_file(out / "atlas.json");
    const test::JsonSchema schema(json_file(std::string(LUMEL_SOURCE_DIR) + "/docs/schema/atlas.schema.json"));
    for (const std::string& line : schema.errors(json)) ADD_FAILURE() << line;
    EXPECT_EQ(json["lookups"], (Json{{"filter", "bilinear"}, {"mips", 2}, {"block", 1}}));
    ASSERT_EQ(statistics.mips.size(), 3u);
    EXPECT_EQ(json["statistics"]["mips"], json["pages"][0]["mips"]);
    EXPECT_EQ(statistics.mips[0].used, statistics.used);
    const AtlasPage page = for_mips.atlas.pages[0];
    for (std::uint32_t mip = 0; mip < 3; ++mip) {
        EXPECT_EQ(statistics.mips[mip].texels, std::uint64_t{page.width >> mip} * (page.height >> mip));
        // Lookups in a lower mip touch no less of the page.
        if (mip > 0) {
            EXPECT_GT(statistics.mips[mip].efficiency(), statistics.mips[mip - 1].efficiency());
        }
    }
    const auto record = read_atlas_record(out / "atlas.json");
    ASSERT_TRUE(record.ok()) << record.error().text();
    EXPECT_EQ((*record)->masks, rule);
}

TEST_F(AtlasFolder, AppearsAsAWholeAndReplacesAnOlderOne) {
    {
        auto writer = AtlasWriter::create(out);
        ASSERT_TRUE(writer.ok());
        ASSERT_TRUE(laid_out.write(*writer).ok());
        EXPECT_FALSE(fs::exists(out / "atlas.json"));
    }
    EXPECT_FALSE(fs::exists(out)) << "a folder that was made for nothing goes";
    write_all(laid_out);
    std::ofstream(out / "atlas_charts_7.png") << "of an older, larger atlas";
    std::ofstream(out / "atlas_charts_x.png") << "somebody's";
    std::ofstream(out / "lightmap_0.exr") << "a bake's";
    write_all(laid_out);
    Names expected = kOnePage;
    expected.insert({"atlas_charts_x.png", "lightmap_0.exr"});
    EXPECT_EQ(names_in(out), expected);
}

TEST_F(AtlasFolder, LeavesWhatIsNotOursAlone) {
    fs::create_directories(out);
    std::ofstream(out / "atlas.json") << R"({"frames": {}})";
    const auto writer = AtlasWriter::create(out);
    ASSERT_FALSE(writer.ok());
    EXPECT_NE(writer.error().text().find("atlas.json"), std::string::npos) << writer.error().text();
    EXPECT_EQ(names_in(out), Names{"atlas.json"});
}

TEST_F(AtlasFolder, PicturesThatNoAtlasWroteAreNotTouched) {
    fs::create_directories(out);
    std::ofstream(out / "atlas_charts_7.png") << "somebody's";
    const auto writer = AtlasWriter::create(out);
    ASSERT_FALSE(writer.ok());
    EXPECT_EQ(writer.error().where, (out / "atlas_charts_7.png").string());
    EXPECT_EQ(names_in(out), Names{"atlas_charts_7.png"});
}

TEST_F(AtlasFolder, IsNotWrittenWhereTheRunIsCancelled) {
    auto writer = AtlasWriter::create(out);
    ASSERT_TRUE(writer.ok());
    laid_out.loaded.context.request_cancel();
    const auto statistics = laid_out.write(*writer);
    ASSERT_FALSE(statistics.ok());
    EXPECT_EQ(statistics.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
